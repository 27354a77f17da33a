# Installs BUILD and moves what was installed, then builds programs of somebody else's with it, as CMake and pkg-config find it, and
# runs them; and builds the example of a kernel from outside, which the installed program uses. The program that uses casacore is
# the one that the guide prints.
# cmake -D BUILD=… -D CONSUMERS=… -D GUIDE=… -D EXAMPLE=… -D COMPILER=… -D FLAGS=… -P install_test.cmake
set(work "${BUILD}/tests/install test")  # a space in the path, on purpose
set(consumers ${work}/consumers)
set(modules ${work}/modules)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY WORKING_DIRECTORY ${work})
endfunction()

# Configures a project of somebody else's; sets `status` and `errors`.
macro(configure source folder)
  execute_process(
    COMMAND ${CMAKE_COMMAND} --no-warn-unused-cli -S ${source} -B ${work}/${folder} -D CMAKE_PREFIX_PATH=${work}/prefix
            -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_C_FLAGS=${FLAGS} -D CMAKE_CXX_FLAGS=${FLAGS} ${ARGN}
    RESULT_VARIABLE status ERROR_VARIABLE errors OUTPUT_QUIET)
endmacro()

function(build source folder)
  configure(${source} ${folder} ${ARGN})
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${folder}: ${errors}")
  endif()
  run(${CMAKE_COMMAND} --build ${work}/${folder} --parallel)
endfunction()

# With the package asked for `components`, those programs are built and run.
function(uses language components programs)
  build(${consumers} ${language}-${components} -D LANGUAGE=${language} -D COMPONENTS=${components} -D PROGRAMS=${programs} ${ARGN})
  separate_arguments(programs)
  foreach(program IN LISTS programs)
    run(${work}/${language}-${components}/${program})
  endforeach()
endfunction()

# The package refuses, and says `expected`.
function(refuses language components expected)
  configure(${consumers} refused-${components} -D LANGUAGE=${language} -D COMPONENTS=${components} -D PROGRAMS= ${ARGN})
  string(REGEX REPLACE "[ \n]+" " " errors "${errors}")
  string(FIND "${errors}" "${expected}" at)
  if(status EQUAL 0 OR at EQUAL -1)
    message(FATAL_ERROR "find_package(misfit COMPONENTS ${components}) does not say \"${expected}\": ${errors}")
  endif()
endfunction()

# Lets pkg-config find this module of the system's too, in a folder that holds no others.
function(let_find)
  foreach(module IN LISTS ARGN)
    execute_process(COMMAND env -u PKG_CONFIG_LIBDIR pkg-config --variable=pcfiledir ${module}
                    OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    file(COPY ${folder}/${module}.pc DESTINATION ${modules})
  endforeach()
endfunction()

# Compiles by one command with what pkg-config says of the module.
function(compile module)
  execute_process(COMMAND pkg-config --cflags --libs ${module} OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run(${ARGN} ${FLAGS} ${flags})
endfunction()

file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${modules})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/first)
file(RENAME ${work}/first ${work}/prefix)
file(COPY ${CONSUMERS}/ DESTINATION ${consumers})
file(READ ${GUIDE}/other-imagers.md page)
string(REGEX REPLACE "^.*\n```cpp\n" "" program "${page}")
string(FIND "${program}" "```" end)
string(SUBSTRING "${program}" 0 ${end} program)
file(WRITE ${consumers}/hosts.cpp "${program}")
run(${work}/prefix/bin/misfit kernel --emit casacore --width 7 --output k.fits)

# Components look for what they are made of, and for no more.
set(ENV{PKG_CONFIG_LIBDIR} ${modules})
set(without_hwy -D CMAKE_DISABLE_FIND_PACKAGE_hwy=ON)
uses(C kernels_c kernels_c -D CMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)
refuses(C kernels "misfit::kernels needs a project with the language CXX")
refuses(CXX kernels "misfit::kernels needs cfitsio, which pkg-config does not find")
refuses(CXX kernel "misfit has no component kernel; expected one of: kernel_plugin, ")
let_find(cfitsio)
uses(CXX kernels kernels ${without_hwy})
refuses(CXX imager "misfit::imager needs hwy 1.0, which CMake does not find" ${without_hwy})
let_find(fftw3 fftw3f)
uses(CXX imager imager)
refuses(CXX ms_io "misfit::ms_io needs casacore, which pkg-config does not find")
unset(ENV{PKG_CONFIG_LIBDIR})
uses(CXX "" "hosts ms_io")

# pkg-config, of which the libraries are known by where its files lie.
file(GLOB_RECURSE found ${work}/prefix/*/misfit-kernels.pc)
cmake_path(GET found PARENT_PATH found)
cmake_path(GET found PARENT_PATH libraries)
set(ENV{PKG_CONFIG_PATH} ${found})
foreach(component kernels imager ms_io hosts)
  compile(misfit-${component} ${COMPILER} -std=c++17 ${consumers}/${component}.cpp -o ${component})
  run(${work}/${component})
endforeach()
execute_process(COMMAND ${work}/hosts WORKING_DIRECTORY ${work} OUTPUT_VARIABLE errors)
if(NOT errors MATCHES "own function +7\\..e-03.*our table +[78]\\..e-05.*in its place +[67]\\..e-05")
  message(FATAL_ERROR "The guide's gridding.cpp prints ${errors}")
endif()
compile(misfit-kernels_c cc -std=c99 -Wall -Wextra -Wpedantic -Werror ${consumers}/kernels_c.c -o kernels_c -lm)
run(env LD_LIBRARY_PATH=${libraries} ${work}/kernels_c)

# Every installed header finds those that it includes, in C++17.
file(GLOB_RECURSE headers RELATIVE ${work}/prefix/include/misfit ${work}/prefix/include/misfit/*.h)
list(TRANSFORM headers REPLACE "(.+)" "#include \"\\1\"\n")
list(JOIN headers "" headers)
file(WRITE ${work}/headers.cpp "${headers}")
compile("misfit-ms_io;misfit-hosts" ${COMPILER} -std=c++17 -fsyntax-only headers.cpp)

build(${EXAMPLE} hann -D CMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)  # as where there is no CFITSIO, FFTW, casacore
run(${work}/prefix/bin/misfit kernel --kernel hann --kernel-folder ${work}/hann --width 6 --x0 0.25 --output ${work}/k.fits)
run(${work}/prefix/bin/misfit kernel --inspect ${work}/k.fits)
file(REMOVE_RECURSE ${work})
