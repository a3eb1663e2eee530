# Installs and exports the package Glint: find_package(Glint) gives Glint::runtime, Glint::gltf, Glint::compiler,
# Glint::session, Glint::measure, Glint::glint and glint_add_materials(), from a prefix or from a build folder.
include(CMakePackageConfigHelpers)

set(glint_targets glint_package glint_runtime)
if(GLINT_BUILD_COMPILER)
  # glint_base, glint_image, glint_inspect and glint_synthetic, as glint_package, are what the others link; they are no interface of their own.
  list(APPEND glint_targets glint_base glint_gltf glint_compiler glint_image glint_inspect glint_synthetic glint_session
       glint_measure glint)
endif()
install(TARGETS ${glint_targets} EXPORT GlintTargets
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(companion glint-view glint-verify)
  if(TARGET ${companion})
    install(TARGETS ${companion} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()
install(DIRECTORY runtime/include/glint DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} PATTERN internal EXCLUDE)
install(DIRECTORY shaders/interop DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/glint/shaders FILES_MATCHING PATTERN "*.h")
if(GLINT_BUILD_COMPILER)
  # The headers that those of the libraries include. All others are internal.
  foreach(header base/fields_fwd.h base/files.h base/memo.h base/shared_array.h emit/compile.h emit/glsl/text.h
                 emit/material_compiler.h
                 emit/material_layout.h
                 emit/package/compiled_package.h gltf/animation.h gltf/import.h gltf/import_options.h gltf/material_set.h
                 gltf/planning_inputs.h gltf/scene.h gltf/scene_list.h gltf/texels/fit.h gltf/texels/levels.h
                 image/compare.h image/png.h image/text.h materials/expression.h
                 materials/interval.h materials/material.h materials/material_model.h materials/value_type.h plan/cost.h plan/effects.h
                 plan/frame_rounds.h plan/gpu_costs.h plan/key.h plan/lock.h plan/merge.h plan/plan.h
                 plan/strategy_cost.h resolve/build.h resolve/resolve.h settings/descriptor.h settings/settings.h
                 spirv/statistics.h)
    cmake_path(GET header PARENT_PATH folder)
    install(FILES tool/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/glint/compiler/${folder})
  endforeach()
  install(FILES runtime/include/glint/internal/package_format.h runtime/include/glint/internal/package_modules.h
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/glint/internal)
  install(DIRECTORY tool/session/include/glint tool/measure/include/glint DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()
install(EXPORT GlintTargets NAMESPACE Glint:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Glint)
export(EXPORT GlintTargets NAMESPACE Glint:: FILE "${CMAKE_CURRENT_BINARY_DIR}/GlintTargets.cmake")
configure_file(cmake/GlintMaterials.cmake "${CMAKE_CURRENT_BINARY_DIR}/GlintMaterials.cmake" COPYONLY)

configure_package_config_file(cmake/GlintConfig.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/GlintConfig.cmake"
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Glint)
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/GlintConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_CURRENT_BINARY_DIR}/GlintConfig.cmake" "${CMAKE_CURRENT_BINARY_DIR}/GlintConfigVersion.cmake"
              cmake/GlintMaterials.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Glint)
