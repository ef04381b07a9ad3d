# Looks for what the second part of packages.txt brings (VTK, Python's headers and so on). Where any of it is absent, what needs it is left
# out: the readers and writers of VTK's files, the Python module, the installation and the tests. `./do tables` and `./do run` build without it.
find_package(Catch2 2 QUIET) # sets the path of its module
block(PROPAGATE absent) # VTK sets variables of many other packages
  find_package(VTK 9.1 QUIET COMPONENTS FiltersCore IOGeometry IOImage IOLegacy IOXML IOXMLParser)
  find_package(LibArchive QUIET)
  find_package(ZLIB QUIET)
  find_package(benchmark QUIET)
  find_path(PYTHON_HEADERS Python.h PATHS /usr/include PATH_SUFFIXES python3.11 NO_DEFAULT_PATH)
  find_path(PYBIND11_HEADERS pybind11/pybind11.h)
  set(absent)
  foreach(package VTK LibArchive ZLIB Catch2 benchmark)
    if(NOT ${package}_FOUND)
      list(APPEND absent ${package})
    endif()
  endforeach()
  foreach(headers PYTHON_HEADERS PYBIND11_HEADERS)
    if(NOT ${headers})
      list(APPEND absent ${headers})
    endif()
  endforeach()
endblock()
string(COMPARE EQUAL "${absent}" "" whole)
set(SPRINGPROOF_IS_WHOLE ${whole} CACHE INTERNAL "read by ./do")
if(NOT SPRINGPROOF_IS_WHOLE)
  list(JOIN absent " " absent)
  message(NOTICE "Left out are the readers and writers of VTK's files, the Python module, the installation and the tests: "
    "${absent} not found. `./do build` installs what is missing and builds them.")
endif()
