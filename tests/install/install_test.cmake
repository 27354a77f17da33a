# Installs BUILD into a temporary folder, then configures, builds and runs the consumer against it; and builds the example of a
# kernel from outside, which the installed program uses.
# cmake -D BUILD=… -D CONSUMER=… -D EXAMPLE=… -D COMPILER=… -D FLAGS=… -P install_test.cmake
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
run(${CMAKE_COMMAND} -S ${EXAMPLE} -B ${work}/hann -D CMAKE_PREFIX_PATH=${work}/prefix -D CMAKE_CXX_FLAGS=${FLAGS}
    -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)  # as where there is no FFTW, CFITSIO, casacore
run(${CMAKE_COMMAND} --build ${work}/hann)
run(${work}/prefix/bin/misfit kernel --kernel hann --kernel-folder ${work}/hann --width 6 --x0 0.25 --output ${work}/k.fits)
run(${work}/prefix/bin/misfit kernel --inspect ${work}/k.fits)
file(REMOVE_RECURSE ${work})
