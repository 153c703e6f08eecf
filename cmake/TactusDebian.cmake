# cpack -G DEB: one package with program, plugins, models, examples, headers and CMake files.  scripts/package makes and
# checks it.
set(TACTUS_PACKAGER "Tactus <tactus@example.org>" CACHE STRING "Who answers for the package: Name <address>")
set(CPACK_PACKAGE_NAME tactus)
set(CPACK_PACKAGE_VENDOR Tactus)
set(CPACK_PACKAGE_CONTACT "${TACTUS_PACKAGER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "stacks of prioritised contact tasks as robot torque controllers")
set(CPACK_PACKAGE_DESCRIPTION "Tactus turns an XML stack of prioritised contact tasks into a torque
controller, by a null-space cascade, a weighted QP or a strict hierarchical
QP, and runs it on a simulated robot that feels its way around.
It brings what plugins with tasks, signals and back ends of one's own are
built against.")
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/package)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/packaging/triggers)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, libeigen3-dev, libgtest-dev")

install(FILES packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/tactus)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/packaging/changelog
                OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/tactus)
include(CPack)
