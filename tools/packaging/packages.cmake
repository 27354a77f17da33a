# cpack: .deb packages of what install.cmake and the Python module install, a package for each component:
# runtime: misfit; dev: libmisfit-dev; python: python3-misfit, where the module is built.
set(components runtime dev)
if(TARGET misfit_python)
  list(APPEND components python)
endif()
set(runtime_package misfit)
set(dev_package libmisfit-dev)
set(python_package python3-misfit)

set(CPACK_GENERATOR DEB)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "the misfit authors" CACHE STRING "Who makes these packages: Name <address>")
set(version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own, the first line of its description

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${runtime_package})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS casacore-data)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS gnuplot-nox)  # reports need it; images come without pictures
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS openmpi-bin)  # for runs of several processes
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/triggers)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
"radio-interferometric imaging with least-misfit gridding functions
Images and cleans MeasurementSets to an accuracy that is asked for, predicts
the visibilities of models, and makes gridding functions, for other imagers
too. It solves for the function that makes the image differ least from the
direct Fourier transform, and says how wrong its images are.")

# Static libraries name no others: who links them needs what misfitConfig.cmake.in looks for.
set(CPACK_DEBIAN_DEV_PACKAGE_NAME ${dev_package})
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "${runtime_package} (= ${version}), casacore-dev, libcfitsio-dev, libeigen3-dev, libfftw3-dev, libhwy-dev, pkg-config")
set(CPACK_DEBIAN_DEV_DESCRIPTION
"libraries of misfit for C++ and C: kernels, imager, MeasurementSets
Static libraries of C++17 with their headers, CMake package and pkg-config
files: least-misfit gridding functions, transforms between visibilities and
images, CLEAN, and MeasurementSets in and out.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME ${python_package})
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-matplotlib)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"radio-interferometric imaging of numpy arrays with misfit
Transforms between visibilities and images to an accuracy that is asked for,
CLEAN, and least-misfit gridding functions with their errors.")
if(TARGET misfit_python)
  get_target_property(suffix misfit_python SUFFIX)
  if(NOT suffix MATCHES "cpython-3([0-9]+)")
    message(STATUS "There will be no package of the Python module: ${suffix} names no version of CPython")
    list(REMOVE_ITEM components python)
    set(CPACK_COMPONENTS_ALL ${components})
  else()
    math(EXPR next "${CMAKE_MATCH_1} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.${CMAKE_MATCH_1}), python3 (<< 3.${next}), python3-numpy")
  endif()
endif()

# What Debian wants beside every package's files, and no other installation.
file(READ LICENSE licence)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)" holder "${licence}")
string(REGEX REPLACE ", " " " holder "${CMAKE_MATCH_1}")
string(REGEX REPLACE "^[^\n]*\n\nCopyright[^\n]*\n\n" "" licence "${licence}")
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(STRIP "${licence}" licence)
string(REGEX REPLACE "\n" "\n " licence " ${licence}")
configure_file(tools/packaging/copyright.in ${PROJECT_BINARY_DIR}/packaging/copyright @ONLY)
set(signed ${CPACK_DEBIAN_PACKAGE_MAINTAINER})
if(NOT signed MATCHES "<")
  string(APPEND signed " <>")
endif()
string(TIMESTAMP now "%a, %d %b %Y %H:%M:%S +0000" UTC)  # or $SOURCE_DATE_EPOCH
foreach(component ${components})
  set(name ${${component}_package})
  set(folder ${PROJECT_BINARY_DIR}/packaging/${name})
  file(CONFIGURE OUTPUT ${folder}/changelog.Debian @ONLY CONTENT
"@runtime_package@ (@version@) unstable; urgency=medium

  * Version @PROJECT_VERSION@.

 -- @signed@  @now@
")
  execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${PROJECT_BINARY_DIR}/packaging/copyright ${folder}/changelog.Debian.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

include(CPack)
