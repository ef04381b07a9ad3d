# `cmake --install build --prefix DIR`: a folder that can be moved as a whole. bin/springproof finds lib/ by its own place, and
# lib/libspringproof.so finds lib/springproof/ and share/springproof/ by its (cases/case/installation.hpp).
include(CMakePackageConfigHelpers)

set_target_properties(springproof PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")
set_target_properties(springproof_solvers PROPERTIES INSTALL_RPATH "$ORIGIN/..")
install(TARGETS springproof RUNTIME DESTINATION bin)
install(TARGETS springproof_library EXPORT springproof LIBRARY DESTINATION lib INCLUDES DESTINATION include/springproof)
install(TARGETS springproof_solvers springproof_gmsh springproof_vtk springproof_kernel_calls
  LIBRARY DESTINATION lib/springproof RUNTIME DESTINATION lib/springproof)

# Headers of what others can call. Those of the solvers' shared object and of commands are this project's own.
foreach(folder cases mechanics msm fem_reference compare/error_bars compare/gates compare/measure compare/provenance compare/solve)
  cmake_path(GET folder PARENT_PATH parent)
  install(DIRECTORY ${folder} DESTINATION include/springproof/${parent} FILES_MATCHING PATTERN *.hpp
    PATTERN petsc EXCLUDE PATTERN snes EXCLUDE PATTERN ranks* EXCLUDE PATTERN solvers.hpp EXCLUDE PATTERN kernels_* EXCLUDE PATTERN packs.hpp EXCLUDE)
endforeach()
set(package lib/cmake/springproof)
install(EXPORT springproof NAMESPACE springproof:: DESTINATION ${package} FILE springproofTargets.cmake)
configure_package_config_file(cmake/springproofConfig.cmake.in ${CMAKE_BINARY_DIR}/springproofConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/springproofConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/springproofConfig.cmake ${CMAKE_BINARY_DIR}/springproofConfigVersion.cmake DESTINATION ${package})

# The man page and the completion for bash say what the program says of itself.
foreach(form man bash)
  set(file ${CMAKE_BINARY_DIR}/springproof.${form})
  add_custom_command(OUTPUT ${file} COMMAND springproof describe ${form} > ${file} DEPENDS springproof VERBATIM)
  list(APPEND described ${file})
endforeach()
add_custom_target(springproof_described ALL DEPENDS ${described})
install(FILES ${CMAKE_BINARY_DIR}/springproof.man DESTINATION share/man/man1 RENAME springproof.1)
install(FILES ${CMAKE_BINARY_DIR}/springproof.bash DESTINATION share/bash-completion/completions RENAME springproof)
install(FILES LICENSE NOTICE.md CHANGELOG.md README.md DESTINATION share/doc/springproof)
install(FILES cmake/copyright DESTINATION share/doc/springproof)
install(DIRECTORY docs examples DESTINATION share/doc/springproof)

# ./do package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "the authors of springproof <springproof@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "mass-spring models of soft tissue against finite elements")
set(CPACK_PACKAGE_DESCRIPTION "Solves each case twice, with springs and with finite elements, evaluates the same
measures on both, and prints the error.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_DEPENDS libopenblas0-pthread) # which the library asks for under the name of any BLAS
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "gnuplot-nox, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "calculix-ccx, python3-getfem, valgrind, libeigen3-dev")
include(CPack)
