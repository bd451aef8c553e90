# The FreeCAD add-on where FreeCAD looks for it, and a Debian package of everything (cpack).
install(DIRECTORY freecad_workbench/ DESTINATION ${CMAKE_INSTALL_DATADIR}/freecad/Mod/collarmesh
  FILES_MATCHING PATTERN "*.py" PATTERN "*.svg" PATTERN "package.xml"
  PATTERN "brep" EXCLUDE PATTERN "__pycache__" EXCLUDE)

# What Debian asks for beside the files: who may copy it, and what changed.
file(WRITE ${PROJECT_BINARY_DIR}/package/copyright "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: collarmesh

Files: *
Copyright: the maintainers of collarmesh
License: GPL-3+
 This program is free software: you can redistribute it and/or modify it under the terms of the GNU General Public
 License as published by the Free Software Foundation, either version 3 of the License, or (at your option) any
 later version. On Debian systems its text is in /usr/share/common-licenses/GPL-3.
")
file(WRITE ${PROJECT_BINARY_DIR}/package/changelog.Debian "collarmesh (${PROJECT_VERSION}) unstable; urgency=low

  * See /usr/share/doc/collarmesh/changelog.gz.

 -- the maintainers of collarmesh <collarmesh@localhost>  Thu, 01 Jan 1970 00:00:00 +0000
")
foreach(pair ${PROJECT_BINARY_DIR}/package/changelog.Debian,changelog.Debian ${PROJECT_SOURCE_DIR}/CHANGELOG.md,changelog)
  string(REPLACE "," ";" pair ${pair})
  list(GET pair 0 source)
  list(GET pair 1 name)
  execute_process(COMMAND gzip -9n -c ${source} OUTPUT_FILE ${PROJECT_BINARY_DIR}/package/${name}.gz)
  install(FILES ${PROJECT_BINARY_DIR}/package/${name}.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/package/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME collarmesh)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_CONTACT "the maintainers of collarmesh <collarmesh@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS freecad)
include(CPack)
