# Install into WORK/prefix, then configure, build and run the consumer project against it.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed (${result}): ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
must(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_CXX_FLAGS=${CXX_FLAGS} -D CMAKE_PREFIX_PATH=${WORK}/prefix)
must(${CMAKE_COMMAND} --build ${WORK}/build)
must(${WORK}/build/consumer ${MODEL} ${WORK}/box.vtu)
if(EXISTS ${WORK}/build/openmesh_consumer)
  must(${WORK}/build/openmesh_consumer)
endif()
# What is installed loads no library from the current folder.
must(${CMAKE_COMMAND} -E env COLLARMESH_PROGRAM=${WORK}/prefix/bin/collarmesh ${PYTHON} ${TESTS}/cli/hostile_test.py Libraries)
must(${WORK}/prefix/bin/collarmesh check ${WORK}/box.vtu --against ${MODEL})
