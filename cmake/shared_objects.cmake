# Files that are found by the place of the library (cases/case/installation.hpp) and not by that of the sources.
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Symbols of a shared library or module: those of exports.map.
function(springproof_exports target)
  set(map ${CMAKE_SOURCE_DIR}/cmake/exports.map)
  target_link_options(${target} PRIVATE -Wl,--version-script=${map} -Wl,-Bsymbolic-functions)
  if(NOT SPRINGPROOF_SANITIZE) # whose own functions are in the program
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  set_target_properties(${target} PROPERTIES LINK_DEPENDS ${map} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
endfunction()

# springproof_module(NAME source...): a part of the program that load_shared_object() of cases/case/installation.hpp loads.
function(springproof_module name)
  add_library(${name} MODULE ${ARGN})
  set_target_properties(${name} PROPERTIES PREFIX "")
  target_link_libraries(${name} PRIVATE springproof_settings)
  springproof_exports(${name})
endfunction()

# springproof_data(NAME FILE_OR_FOLDER): what data_folder() finds under this name (of a file, its folder): a link to the source, installed
# a copy.
function(springproof_data name source)
  set(link ${CMAKE_BINARY_DIR}/springproof_data/${name})
  cmake_path(GET link PARENT_PATH folder)
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK ${source} ${link} SYMBOLIC)
  cmake_path(GET name PARENT_PATH subfolder)
  if(IS_DIRECTORY ${source})
    install(DIRECTORY ${source}/ DESTINATION share/springproof/${name} REGEX "\\.[ch]pp$|/CMakeLists.txt$|/(case|mesh|scene|node_modules|__pycache__|bullet/client)$" EXCLUDE)
  else()
    install(FILES ${source} DESTINATION share/springproof/${subfolder})
  endif()
endfunction()
