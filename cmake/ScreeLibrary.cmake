# The library: all of scree but pictures and command line in one shared library, which the program is linked against too.
# Users see scree/*.hpp of it (docs/library.md); the program sees the inside as well, so a program and a library of one
# version belong together. Shared, because users of a static one would need all that scree is linked against.
# Until 1.0.0 a minor version may change the interface (CONTRIBUTING.md), so it names the library.
set(SCREE_ABI_VERSION ${PROJECT_VERSION_MAJOR})
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(SCREE_ABI_VERSION 0.${PROJECT_VERSION_MINOR})
endif()

set(parts scree_core scree_broadphase scree_libccd scree_narrowphase scree_observe scree_laws scree_scene scree_bodies scree_pairs
          scree_impacts scree_contacts scree_response scree_model scree_step scree_record)
if(SCREE_CUDA)
  list(APPEND parts scree_broadphase_device)
endif()
# All objects of each part, and not those alone that the interface reaches: the program needs more.
list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
add_library(scree_library SHARED sim/library/interface.cpp ${objects})
set_target_properties(scree_library PROPERTIES
  OUTPUT_NAME scree
  VERSION ${PROJECT_VERSION}
  SOVERSION ${SCREE_ABI_VERSION}
  LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib
  LINK_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/scree.map)
target_link_libraries(scree_library PRIVATE ${parts})
# Calls inside are direct; each build has one library, which nobody is to replace functions of.
target_link_options(scree_library PRIVATE
  LINKER:--version-script=${CMAKE_CURRENT_LIST_DIR}/scree.map LINKER:-Bsymbolic-functions)
target_include_directories(scree_library PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include>)
target_compile_features(scree_library PUBLIC cxx_std_20)
set_target_properties(scree_library PROPERTIES EXPORT_NAME scree)

include(CMakePackageConfigHelpers)
set(compatibility SameMajorVersion)
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
endif()
write_basic_package_version_file(${CMAKE_BINARY_DIR}/library/screeConfigVersion.cmake COMPATIBILITY ${compatibility})

# scree_install_library(LIBDIR RUNTIME DEVELOPMENT): what a program needs to run with the library goes with the arguments of
# install() in the list RUNTIME, what it needs to be built with those of DEVELOPMENT: headers, and what find_package() and
# pkg-config read. All of it may be moved together.
function(scree_install_library libdir runtime development)
  string(MAKE_C_IDENTIFIER scree_${libdir} export)
  string(REGEX REPLACE "[^/]+" ".." up ${libdir})
  configure_file(${CMAKE_SOURCE_DIR}/cmake/scree.pc.in ${CMAKE_BINARY_DIR}/library/${libdir}/scree.pc @ONLY)
  file(WRITE ${CMAKE_BINARY_DIR}/library/screeConfig.cmake "include(\${CMAKE_CURRENT_LIST_DIR}/screeTargets.cmake)\n")
  install(TARGETS scree_library EXPORT ${export} LIBRARY DESTINATION ${libdir} ${runtime} NAMELINK_SKIP)
  install(TARGETS scree_library LIBRARY DESTINATION ${libdir} ${development} NAMELINK_ONLY)
  install(DIRECTORY scree DESTINATION include ${development} FILES_MATCHING PATTERN *.hpp)
  install(EXPORT ${export} FILE screeTargets.cmake NAMESPACE scree:: DESTINATION ${libdir}/cmake/scree ${development})
  install(FILES ${CMAKE_BINARY_DIR}/library/screeConfig.cmake ${CMAKE_BINARY_DIR}/library/screeConfigVersion.cmake
          DESTINATION ${libdir}/cmake/scree ${development})
  install(FILES ${CMAKE_BINARY_DIR}/library/${libdir}/scree.pc DESTINATION ${libdir}/pkgconfig ${development})
endfunction()
