# Configure a project that fetches the sources; with ccache build and run it, as else all is compiled anew. Compiled
# without optimization, as only the build is tested.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Plain
  -D CMAKE_CXX_FLAGS_PLAIN=-DNDEBUG -D CMAKE_CXX_FLAGS=${CXX_FLAGS}
  -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -D COLLARMESH_SOURCES=${SOURCES} -D COLLARMESH_WERROR=${WERROR} -D COLLARMESH_IN_GROUPS=ON)
if(NOT LAUNCHER)
  return()
endif()
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
must(${CMAKE_COMMAND} --build ${WORK} --parallel ${cores})
must(${WORK}/consumer ${SOURCES}/resources/models/box.off ${WORK}/box.vtu)
must(${WORK}/files_consumer ${SOURCES}/resources/models/box.off ${WORK}/files.vtu)
file(GLOB cad ${WORK}/_deps/collarmesh-build/lib/collarmesh/collarmesh_cad.so)
if(cad)
  must(${WORK}/files_consumer ${SOURCES}/resources/models/flange.step ${WORK}/cad.vtu)
endif()
