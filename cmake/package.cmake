# The FreeCAD add-on where FreeCAD looks for it, and a Debian package of everything (cpack).
install(DIRECTORY freecad_workbench/ DESTINATION ${CMAKE_INSTALL_DATADIR}/freecad/Mod/collarmesh
  FILES_MATCHING PATTERN "*.py" PATTERN "*.svg" PATTERN "*.qm" PATTERN "package.xml"
  PATTERN "brep" EXCLUDE PATTERN "bench" EXCLUDE PATTERN "update.py" EXCLUDE PATTERN "make_package.py" EXCLUDE
  PATTERN "__pycache__" EXCLUDE)
install(FILES LICENSE freecad_workbench/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/freecad/Mod/collarmesh)

# Whoever makes packages for others puts in their own name.
set(COLLARMESH_MAINTAINER "The collarmesh maintainers <collarmesh@example.org>" CACHE STRING "of the Debian package")

# Texts that Debian requires in a package: the licence and the changes. `cmake --install` leaves them out.
file(WRITE ${PROJECT_BINARY_DIR}/package/doc/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: collarmesh

Files: *
Copyright: 2026 the collarmesh maintainers
License: GPL-3+
 This program is free software: you can redistribute it and/or modify it under the terms of the GNU General Public
 License as published by the Free Software Foundation, either version 3 of the License, or (at your option) any
 later version. On Debian systems its text is in /usr/share/common-licenses/GPL-3.

Files: usr/bin/collarmesh
Copyright: 2026 the collarmesh maintainers
 2010-2019 the authors of three.js, which is part of reports as HTML
License: GPL-3+ and Expat
 The program is under the GPL as above. For three.js: Permission is hereby granted, free of charge, to any person
 obtaining a copy of this software and associated documentation files (the \"Software\"), to deal in the Software
 without restriction, including without limitation the rights to use, copy, modify, merge, publish, distribute,
 sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so,
 subject to the following conditions: The above copyright notice and this permission notice shall be included in all
 copies or substantial portions of the Software. THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND,
 EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE
 AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
 LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE
 SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
")
file(WRITE ${PROJECT_BINARY_DIR}/package/changelog.Debian "collarmesh (${PROJECT_VERSION}) unstable; urgency=low

  * See /usr/share/doc/collarmesh/changelog.gz.

 -- ${COLLARMESH_MAINTAINER}  Thu, 01 Jan 1970 00:00:00 +0000
")
foreach(pair ${PROJECT_BINARY_DIR}/package/changelog.Debian,changelog.Debian ${PROJECT_SOURCE_DIR}/CHANGELOG.md,changelog)
  string(REPLACE "," ";" pair ${pair})
  list(GET pair 0 source)
  list(GET pair 1 name)
  execute_process(COMMAND gzip -9n -c ${source} OUTPUT_FILE ${PROJECT_BINARY_DIR}/package/doc/${name}.gz)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME collarmesh)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "tetrahedral mesh generator for surfaces, CAD shapes and complexes")
set(CPACK_PACKAGE_DESCRIPTION
  "collarmesh fills a surface, a CAD shape or a piecewise-linear complex with
tetrahedra for finite elements and finite volumes. The mesh conforms to every
vertex, edge and face of the input and comes with a certificate.

The package has the program, an add-on for FreeCAD, a Python module where it
was built, and a C++ library to link with.")
set(CPACK_PACKAGE_CONTACT ${COLLARMESH_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALLED_DIRECTORIES ${PROJECT_BINARY_DIR}/package/doc ${CPACK_PACKAGING_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS freecad)
if(TARGET collarmesh_python)  # the module is for one version of Python
  execute_process(COMMAND ${PYTHON_EXECUTABLE} -c "import sys; v = sys.version_info; \
print(f'python3 (>= {v[0]}.{v[1]}~), python3 (<< {v[0]}.{v[1] + 1}), python3-numpy', end='')"
    OUTPUT_VARIABLE CPACK_DEBIAN_PACKAGE_DEPENDS)
endif()
include(CPack)
