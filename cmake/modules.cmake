# Modules: parts that bring many libraries, loaded when one is needed, as loading them costs more than a small
# mesh. Where they are, and how programs find them.
set(COLLARMESH_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/collarmesh)
set(COLLARMESH_MODULE_BUILD_DIR ${PROJECT_BINARY_DIR}/lib/collarmesh)
list(APPEND CMAKE_BUILD_RPATH ${COLLARMESH_MODULE_BUILD_DIR})
file(RELATIVE_PATH path_from_bin ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/collarmesh)
list(APPEND CMAKE_INSTALL_RPATH $ORIGIN/${path_from_bin})

function(collarmesh_module target)
  set_target_properties(${target} PROPERTIES
    PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    BUILD_RPATH "" INSTALL_RPATH "" LIBRARY_OUTPUT_DIRECTORY ${COLLARMESH_MODULE_BUILD_DIR})
  if(COLLARMESH_INSTALL)
    install(TARGETS ${target} LIBRARY DESTINATION ${COLLARMESH_MODULE_DIR} COMPONENT modules)
  endif()
endfunction()
