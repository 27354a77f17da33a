# cmake --install: the program, the libraries with their headers, and the package that find_package(misfit) and pkg-config find.
# Headers keep their folders: #include "imager/data/geometry.h" works for a consumer as it does here. What programs run with is of the
# install component runtime, what they are built with of dev.
include(CMakePackageConfigHelpers)

set(headers ${CMAKE_INSTALL_INCLUDEDIR}/misfit)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/misfit)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig OUTPUT_VARIABLE to_prefix)

# A library, as misfit::NAME and in misfit-NAME.pc, which says what else a program is to link.
function(misfit_install name)
  cmake_parse_arguments(ARG "" "TARGET;DESCRIPTION;LIBS" "REQUIRES" ${ARGN})
  set_target_properties(${ARG_TARGET} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${ARG_TARGET} EXPORT misfit_${name}
    ARCHIVE COMPONENT dev
    LIBRARY COMPONENT runtime NAMELINK_COMPONENT dev)
  install(EXPORT misfit_${name} NAMESPACE misfit:: DESTINATION ${package} COMPONENT dev)
  list(JOIN ARG_REQUIRES " " requires)
  if(ARG_LIBS)
    set(libs "-L\${libdir} ${ARG_LIBS}")
  endif()
  configure_file(tools/misfit.pc.in ${PROJECT_BINARY_DIR}/pkgconfig/misfit-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/pkgconfig/misfit-${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endfunction()

# The libraries are static, so a consumer links what they are made of; but for kernels_c, which holds it.
list(TRANSFORM CMAKE_DL_LIBS PREPEND " -l" OUTPUT_VARIABLE with_dl)
if(MISFIT_HAS_QUADMATH)
  set(with_quadmath " -lquadmath")
endif()
misfit_install(kernel_plugin TARGET misfit_plugin_interface DESCRIPTION "what a gridding function in a library of its own keeps to")
misfit_install(kernels_c TARGET misfit_kernels_c DESCRIPTION "gridding functions, for C" LIBS "-lmisfit_kernels_c")
misfit_install(kernels TARGET misfit_kernels DESCRIPTION "gridding functions" REQUIRES eigen3 cfitsio
  LIBS "-lmisfit_kernels${with_quadmath}${with_dl}")
misfit_install(imager TARGET misfit_imager DESCRIPTION "transforms between visibilities and images, CLEAN"
  REQUIRES misfit-kernels fftw3 fftw3f libhwy LIBS "-lmisfit_imager -pthread")
misfit_install(ms_io TARGET misfit_ms_io DESCRIPTION "MeasurementSets" REQUIRES misfit-imager casacore LIBS "-lmisfit_ms_io")
misfit_install(hosts TARGET misfit_hosts DESCRIPTION "gridders for casacore" REQUIRES misfit-kernels casacore LIBS "-lmisfit_hosts")

foreach(folder kernels imager ms_io tools/hosts)
  cmake_path(GET folder PARENT_PATH parent)
  install(DIRECTORY ${folder} DESTINATION ${headers}/${parent} COMPONENT dev FILES_MATCHING PATTERN "*.h"
    PATTERN "*_internal.h" EXCLUDE PATTERN example_kernel EXCLUDE)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/generated/kernels/version.h DESTINATION ${headers}/kernels COMPONENT dev)
configure_package_config_file(tools/misfitConfig.cmake.in ${PROJECT_BINARY_DIR}/misfitConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/misfitConfig.cmake ${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake DESTINATION ${package} COMPONENT dev)

if(TARGET misfit)
  install(TARGETS misfit RUNTIME COMPONENT runtime)
  install(DIRECTORY ${misfit_manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT runtime)
  install(FILES ${misfit_manual}/misfit DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT runtime)
endif()
if(TARGET misfit_guide)
  install(DIRECTORY ${misfit_guide}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/guide COMPONENT runtime
    FILES_MATCHING PATTERN "*.html" PATTERN "figures/*" PATTERN CMakeFiles EXCLUDE)
endif()
install(TARGETS misfit_wsclean LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/misfit COMPONENT runtime)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)  # packages have it in their copyright
