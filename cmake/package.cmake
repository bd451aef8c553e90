# The FreeCAD add-on where FreeCAD looks for it, and a Debian package of everything (cpack).
install(DIRECTORY freecad_workbench/ DESTINATION ${CMAKE_INSTALL_DATADIR}/freecad/Mod/collarmesh
  FILES_MATCHING PATTERN "*.py" PATTERN "*.svg" PATTERN "package.xml"
  PATTERN "brep" EXCLUDE PATTERN "__pycache__" EXCLUDE)

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
