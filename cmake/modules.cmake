# Modules are parts that need many libraries. Programs load a module only when they need it, because loading
# it takes longer than making a small mesh. Sets where modules are, and how programs find them.
set(COLLARMESH_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/collarmesh)
set(COLLARMESH_MODULE_BUILD_DIR ${PROJECT_BINARY_DIR}/lib/collarmesh)
list(APPEND CMAKE_BUILD_RPATH ${COLLARMESH_MODULE_BUILD_DIR})

# Sets the run path of a target that is installed in `folder` (absolute). The target in the build folder has the
# same run path, which therefore also contains ../lib/collarmesh. If CMake had to replace the run path at the
# installation, it would end the one in the build folder with a colon, which stands for the current folder.
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
