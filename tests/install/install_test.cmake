# Installs BUILD into a temporary folder, then configures, builds and runs the consumer against it.
# cmake -D BUILD=… -D CONSUMER=… -D FLAGS=… -P install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

set(work "${BUILD}/tests/install test")  # a space in the path, on purpose
file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${work}/consumer -D CMAKE_PREFIX_PATH=${work}/prefix -D CMAKE_CXX_FLAGS=${FLAGS}
    -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${work}/consumer)
run(${work}/consumer/consumer WORKING_DIRECTORY ${work})
file(REMOVE_RECURSE ${work})
