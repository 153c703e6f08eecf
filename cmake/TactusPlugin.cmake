# tactus_add_plugin(NAME SOURCES...): a loadable library NAME.so that `tactus` finds by that name.
# Tactus itself sets TACTUS_PLUGIN_FOLDER, where its own plugins are built and which installs them; in another project
# the library is built where that project builds its libraries.
include_guard()
include(GNUInstallDirs)
function(tactus_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE Tactus::framework)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  if(TACTUS_PLUGIN_FOLDER)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${TACTUS_PLUGIN_FOLDER})
    install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/tactus/plugins)
  endif()
endfunction()
