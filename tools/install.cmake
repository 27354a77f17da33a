# cmake --install: the program, the libraries with their headers, and the package that find_package(misfit) finds.
# Headers keep their folders: #include "imager/geometry.h" works for a consumer as it does here.
include(CMakePackageConfigHelpers)

set(headers ${CMAKE_INSTALL_INCLUDEDIR}/misfit)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/misfit)

foreach(folder kernels imager ms_io tools/hosts)
  cmake_path(GET folder FILENAME name)
  cmake_path(GET folder PARENT_PATH parent)
  set_target_properties(misfit_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS misfit_${name} EXPORT misfitTargets INCLUDES DESTINATION ${headers})
  install(DIRECTORY ${folder} DESTINATION ${headers}/${parent} FILES_MATCHING PATTERN "*.h" PATTERN "*_internal.h" EXCLUDE)
endforeach()
# Apart from the rest, so that kernels from outside need none of the libraries that those are made of.
set_target_properties(misfit_plugin_interface PROPERTIES EXPORT_NAME kernel_plugin)
install(TARGETS misfit_plugin_interface EXPORT misfitKernelPlugin)
install(EXPORT misfitKernelPlugin NAMESPACE misfit:: DESTINATION ${package})
if(TARGET misfit)
  install(TARGETS misfit)
endif()
install(TARGETS misfit_wsclean LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/misfit)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(tools/misfitConfig.cmake.in ${PROJECT_BINARY_DIR}/misfitConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT misfitTargets NAMESPACE misfit:: DESTINATION ${package})
install(FILES ${PROJECT_BINARY_DIR}/misfitConfig.cmake ${PROJECT_BINARY_DIR}/misfitConfigVersion.cmake DESTINATION ${package})
