# Looks for what the second part of packages.txt brings. Where any of it is absent, what needs it is left out: the readers and writers of
# VTK's files, the pages' scripts, the Python module, the installation and the tests. `tables` and `run` do without.
find_package(Catch2 2 QUIET) # sets the path of its CMake module
block(PROPAGATE absent) # VTK sets variables of many other packages
  find_package(VTK 9.1 QUIET COMPONENTS FiltersCore IOGeometry IOImage IOLegacy IOXML IOXMLParser)
  find_package(LibArchive QUIET)
  find_package(ZLIB QUIET)
  find_package(benchmark QUIET)
  file(GLOB PYTHON_H /usr/include/python3*/Python.h) # those of Debian's own Python, whichever comes first in PATH
  find_file(PYBIND11_H pybind11/pybind11.h)
  find_file(THREE_JS three.min.js PATHS /usr/share/javascript/three /usr/share/nodejs/three/build NO_DEFAULT_PATH)
  find_file(ORBIT_CONTROLS_JS OrbitControls.js
    PATHS /usr/share/javascript/three/examples/js/controls /usr/share/nodejs/three/examples/js/controls NO_DEFAULT_PATH)
  find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH)
  set(absent)
  foreach(package VTK LibArchive ZLIB Catch2 benchmark)
    if(NOT ${package}_FOUND)
      list(APPEND absent ${package})
    endif()
  endforeach()
  foreach(file PYTHON_H PYBIND11_H THREE_JS ORBIT_CONTROLS_JS CHART_JS)
    if(NOT ${file})
      list(APPEND absent ${file})
    endif()
  endforeach()
endblock()
string(COMPARE EQUAL "${absent}" "" whole)
set(SPRINGPROOF_IS_WHOLE ${whole} CACHE INTERNAL "read by ./do")
if(NOT SPRINGPROOF_IS_WHOLE)
  list(JOIN absent " " absent)
  message(NOTICE "Left out: the readers and writers of VTK's files, the Python module, the installation and the tests, for want of "
    "${absent}. `./do build` installs what is missing and builds them.")
endif()
