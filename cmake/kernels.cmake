# springproof_kernels(TARGET SOURCE OPTION...): adds kernels to a library: one source (a header of kernels, which defines
# SPRINGPROOF_ISA::kernels) compiled with these options for three instruction sets; mechanics/grid/instruction_set.hpp picks one when the
# program starts. Each is compiled by itself, without the library's precompiled header.
function(springproof_kernels target source)
  # GCC 12 takes the undefined registers of AVX-512's intrinsics for oversights.
  set(flags_baseline)
  set(flags_avx2 -mavx2 -mfma)
  set(flags_avx512 -Wno-maybe-uninitialized -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512)
  foreach(set baseline avx2 avx512)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/kernels_${set}.cpp)
    file(CONFIGURE OUTPUT ${file} CONTENT "#define SPRINGPROOF_ISA ${set}\n#include \"${source}\"\n")
    target_sources(${target} PRIVATE ${file})
    set_source_files_properties(${file} PROPERTIES COMPILE_OPTIONS "${ARGN};$<IF:$<CONFIG:Release>,-O3,-O1>;${flags_${set}}"
      SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()
