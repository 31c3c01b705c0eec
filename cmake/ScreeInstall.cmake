# `cmake --install BUILD --prefix DIR` makes a folder that runs on another Linux machine: bin/scree, the benchmarks that
# were built, their libraries, the scenes; and what other programs need to be built with the library.

# ./run and the tests find the program here, whatever folder makes it.
set_target_properties(scree PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

scree_install_library(lib "" "")
install(CODE "file(GLOB benchmarks \"${CMAKE_BINARY_DIR}/bench/*/scree_bench_*\")
execute_process(
  COMMAND ${CMAKE_SOURCE_DIR}/scripts/bundle.sh \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\" $<TARGET_FILE:scree> \${benchmarks}
  COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY configs DESTINATION .)
install(FILES LICENSE README.md DESTINATION . OPTIONAL)
