# Tests by tier: `./do test [long|sanitize|release]` runs those whose label it is. docs/developing/tests.md says what each tier holds.
include(Catch)
set(alone OPENBLAS_NUM_THREADS=1) # tests run side by side
set(mpi ${alone} OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1) # a container has no other user
# No test takes a quarter of its limit (seconds).
set(limit_default 300)
set(limit_long 1800)
set(limit_sanitize 3600)
set(limit_release 14400)

# Everything that tests run; no other target builds it.
add_custom_target(springproof_all_tests)

# springproof_test(TIER NAME [KIND kind] [PROCESSORS n] [LIMIT seconds] [ENVIRONMENT name=value...] [PROPERTIES name value...]
#                  COMMAND word...)
# A test of one TIER and one KIND (unit by default). Exit status 77 counts as skipped. The default tier's tests leave their processor time
# in build/processor_time, which suite/default_is_short judges.
function(springproof_test tier name)
  cmake_parse_arguments(PARSE_ARGV 2 ARG "" "KIND;PROCESSORS;LIMIT" "COMMAND;ENVIRONMENT;PROPERTIES")
  if(SPRINGPROOF_SANITIZE)
    return() # sanitize/run.sh runs what it needs
  endif()
  foreach(default KIND=unit PROCESSORS=1 LIMIT=${limit_${tier}} ENVIRONMENT=${alone})
    string(REGEX MATCH "^([A-Z]+)=(.*)$" matched "${default}")
    if(NOT DEFINED ARG_${CMAKE_MATCH_1})
      set(ARG_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
    endif()
  endforeach()
  if(tier STREQUAL default)
    list(PREPEND ARG_COMMAND python3 ${CMAKE_SOURCE_DIR}/tests/support/processor_time.py ${CMAKE_BINARY_DIR}/processor_time "${name}")
  endif()
  add_test(NAME "${name}" COMMAND ${ARG_COMMAND})
  set_tests_properties("${name}" PROPERTIES LABELS "${tier};${ARG_KIND}" TIMEOUT ${ARG_LIMIT} PROCESSORS ${ARG_PROCESSORS}
    ENVIRONMENT "${ARG_ENVIRONMENT}" SKIP_REGULAR_EXPRESSION "nothing was (compared|checked)|the test is skipped" ${ARG_PROPERTIES})
endfunction()

# springproof_tests(FOLDER SOURCES file... LIBRARIES target...) builds springproof_<FOLDER>_tests from the files of tests/ and
# registers one test a file and kind. A test case has at most one of the Catch2 tags [verification], [regression] and [peer], which is its
# kind; any other is a unit test. A test case that takes more than some seconds has the tag [long] too, one that takes minutes [release]: it is
# a test of its own, of that tier. Tests find the project's files through the macro SPRINGPROOF_SOURCE_DIR (a string).
function(springproof_tests folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  set(target springproof_${folder}_tests)
  add_executable(${target} ${ARG_SOURCES})
  add_dependencies(springproof_all_tests ${target})
  target_compile_definitions(${target} PRIVATE
    SPRINGPROOF_SOURCE_DIR="${CMAKE_SOURCE_DIR}" SPRINGPROOF_PROGRAM="$<TARGET_FILE:springproof>")
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} Catch2::Catch2WithMain)
  # Programs with the same libraries have the same flags, and share what was parsed once. Each then waits for the first of them as a
  # whole, which the sanitizers' build does not have.
  string(MAKE_C_IDENTIFIER "springproof_headers_of_${ARG_LIBRARIES}" headers)
  get_property(first GLOBAL PROPERTY ${headers})
  if(first AND NOT SPRINGPROOF_SANITIZE)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE <Eigen/Dense> <catch2/catch.hpp>)
    set_property(GLOBAL PROPERTY ${headers} ${target})
  endif()
  # fmt 9 calls an unqualified compare(), which a source before it, of those compiled together, makes a namespace.
  set_target_properties(${target} PROPERTIES UNITY_BUILD_CODE_BEFORE_INCLUDE "#include <fmt/format.h>")
  set(kinds verification regression peer)
  list(JOIN kinds "]~[" not_these)
  foreach(source IN LISTS ARG_SOURCES)
    springproof_kinds_of(${source} found)
    get_filename_component(file ${source} NAME_WE)
    get_filename_component(place ${source} DIRECTORY)
    foreach(kind IN LISTS found)
      if(kind STREQUAL unit)
        set(name ${place}/${file})
        set(spec "[#${file}]~[.]~[long]~[release]~[${not_these}]")
      else()
        set(name ${place}/${file}/${kind})
        set(spec "[#${file}][${kind}]~[.]~[long]~[release]")
      endif()
      springproof_test(default ${name} KIND ${kind} COMMAND $<TARGET_FILE:${target}> -w NoTests "-#" ${spec})
    endforeach()
  endforeach()
  foreach(tier long release)
    springproof_has_tag(${tier} "${ARG_SOURCES}" has_tier)
    if(has_tier AND NOT SPRINGPROOF_SANITIZE)
      catch_discover_tests(${target} TEST_SPEC "[${tier}]" TEST_PREFIX "${folder}/" TEST_LIST ${target}_${tier} EXTRA_ARGS -w NoTests
        WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
        PROPERTIES LABELS ${tier} TIMEOUT ${limit_${tier}} SKIP_REGULAR_EXPRESSION "nothing was compared" ENVIRONMENT ${alone})
    endif()
  endforeach()
endfunction()

# Whether a test case of the sources has the tag.
function(springproof_has_tag tag sources result)
  set(${result} OFF PARENT_SCOPE)
  foreach(source IN LISTS sources)
    file(STRINGS ${source} lines REGEX "\\[${tag}\\]")
    if(lines)
      set(${result} ON PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# Kinds of a source's test cases that are not [long] or [release]. Test cases are found in the text, and again whenever the source changes.
function(springproof_kinds_of source result)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
  file(READ ${source} text)
  string(REGEX REPLACE "[][;]" "|" text "${text}") # a list's own characters
  string(REGEX MATCHALL "TEST_CASE(_METHOD)?\\([^{]*" cases "${text}")
  set(found)
  foreach(case IN LISTS cases)
    if(case MATCHES "\\|(long|release)\\|" OR case MATCHES "\\|\\.\\|")
      continue()
    endif()
    if(case MATCHES "\\|(verification|regression|peer)\\|")
      list(APPEND found ${CMAKE_MATCH_1})
    else()
      list(APPEND found unit)
    endif()
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${result} "${found}" PARENT_SCOPE)
endfunction()
