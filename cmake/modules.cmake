# Modules: parts that bring many libraries, loaded when one is needed, as loading them costs more than a small
# mesh. Where they are, and how programs find them.
set(COLLARMESH_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/collarmesh)
set(COLLARMESH_MODULE_BUILD_DIR ${PROJECT_BINARY_DIR}/lib/collarmesh)
list(APPEND CMAKE_BUILD_RPATH ${COLLARMESH_MODULE_BUILD_DIR})

# The run path of an installed target in `folder` (absolute). It is that of the build folder, too, where modules are in
# ../lib: CMake ends one that it is to exchange with a colon, which stands for the current folder.
function(collarmesh_run_path target folder)
  file(RELATIVE_PATH path ${folder} ${CMAKE_INSTALL_FULL_LIBDIR}/collarmesh)
  set(run_path $ORIGIN/${path} $ORIGIN/../lib/collarmesh)
  list(REMOVE_DUPLICATES run_path)
  set_target_properties(${target} PROPERTIES BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "${run_path}")
endfunction()

function(collarmesh_module target)
  set_target_properties(${target} PROPERTIES
    PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "" LIBRARY_OUTPUT_DIRECTORY ${COLLARMESH_MODULE_BUILD_DIR})
  if(COLLARMESH_INSTALL)
    install(TARGETS ${target} LIBRARY DESTINATION ${COLLARMESH_MODULE_DIR} COMPONENT modules)
  endif()
endfunction()
