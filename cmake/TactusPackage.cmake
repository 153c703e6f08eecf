# find_package(Tactus), from the build tree as from an installed one: tactus_add_plugin, and the targets
# Tactus::framework and, for tests, Tactus::conformance.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Tactus)

install(TARGETS tactus_framework tactus_conformance tactus_flags EXPORT TactusTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
set_target_properties(tactus_framework tactus_conformance PROPERTIES
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} INSTALL_RPATH "$ORIGIN")
install(DIRECTORY framework DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus FILES_MATCHING PATTERN "*.h")
install(FILES conformance/bench.h conformance/conformance.h conformance/report.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/conformance)
install(FILES dsl/diagnostic.h dsl/stack.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tactus/dsl)
install(EXPORT TactusTargets NAMESPACE Tactus:: DESTINATION ${package_folder})
export(EXPORT TactusTargets NAMESPACE Tactus:: FILE ${PROJECT_BINARY_DIR}/TactusTargets.cmake)

configure_package_config_file(cmake/TactusConfig.cmake.in ${PROJECT_BINARY_DIR}/TactusConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/TactusConfigVersion.cmake COMPATIBILITY ExactVersion)
file(COPY cmake/TactusPlugin.cmake DESTINATION ${PROJECT_BINARY_DIR})
install(FILES ${PROJECT_BINARY_DIR}/TactusConfig.cmake ${PROJECT_BINARY_DIR}/TactusConfigVersion.cmake
              cmake/TactusPlugin.cmake DESTINATION ${package_folder})
