# Configure a project that fetches the sources, build and run it. Objects that our own build has made by the same commands
# are taken from there (reuse.py); so the commands are compared, and all that differs is compiled.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(COMMAND ninja -C ${BUILD} -t compdb OUTPUT_FILE ${WORK}/commands.json RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  file(WRITE ${WORK}/commands.json "[]")  # no commands to compare with, so everything is compiled
endif()
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${PYTHON};${CMAKE_CURRENT_LIST_DIR}/reuse.py;${WORK}/commands.json;${BUILD};${WORK}/_deps/collarmesh-build;${LAUNCHER}")
must(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_CXX_FLAGS=${CXX_FLAGS}
  -D COLLARMESH_SOURCES=${SOURCES} -D COLLARMESH_WERROR=${WERROR}
  -D COLLARMESH_IN_GROUPS=${IN_GROUPS})
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
must(${CMAKE_COMMAND} --build ${WORK} --parallel ${cores})
if(EXISTS ${WORK}/commands.taken)
  file(STRINGS ${WORK}/commands.taken own REGEX "^CMakeFiles/")
  if(own)
    message(FATAL_ERROR "objects of the project itself were not compiled: ${own}")
  endif()
endif()
must(${WORK}/consumer ${SOURCES}/resources/models/box.off ${WORK}/box.vtu)
must(${WORK}/files_consumer ${SOURCES}/resources/models/box.off ${WORK}/files.vtu)
file(GLOB cad ${WORK}/_deps/collarmesh-build/lib/collarmesh/collarmesh_cad.so)
if(cad)
  must(${WORK}/files_consumer ${SOURCES}/resources/models/flange.step ${WORK}/cad.vtu)
endif()
