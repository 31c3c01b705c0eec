# Language, warnings and the one switch between "one source, two compilers".

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Objects of one clone, preset or branch serve all others: paths in this tree are looked up from the build folder, and
# the folder itself counts for nothing (a debugger may be shown the source of another clone). What a file includes is
# read from the compiler's own list, so that a miss costs no second run of the preprocessor.
find_program(SCREE_CCACHE ccache)
if(SCREE_CCACHE)
  set(launcher env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1 ${SCREE_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_CUDA_COMPILER_LAUNCHER ${launcher})
endif()

# All code may become part of the shared library (ScreeLibrary.cmake); calls inside it are still inlined, because
# nobody is to replace its functions (-fno-semantic-interposition below).
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Programs look for libraries beside themselves first, from the build on, so that copying them makes a folder that
# runs elsewhere (scripts/bundle.sh). The old tag, because the new one does not hold for libraries of libraries.
set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../lib")
add_link_options(LINKER:--disable-new-dtags)

if(SCREE_CUDA)
  # CMake 3.25 does not know CUDA's C++20, so the standard goes through the flags.
  set(CMAKE_CUDA_ARCHITECTURES ${SCREE_CUDA_ARCHITECTURES})
  enable_language(CUDA)
  set(CMAKE_CUDA_STANDARD_REQUIRED OFF)
  find_package(CUDAToolkit REQUIRED)
endif()

# Every target of scree: warnings are errors; Eigen keeps its types free of alignment beyond that of their
# scalars, so that host and device passes agree on every layout; no sums by pairs in Eigen, which it does for vectors
# of four where g++ compiles and never where nvcc does, so that builds with and without nvcc give the same bits (and
# cost the same); no fused multiply-add behind our back, so that host and device round alike; no errno, so that a
# square root is one instruction.
add_library(scree_options INTERFACE)
target_include_directories(scree_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_definitions(scree_options INTERFACE
  EIGEN_MAX_STATIC_ALIGN_BYTES=0
  EIGEN_DONT_VECTORIZE)
set(warnings -Wall -Wextra -Wpedantic -Wshadow -Werror)
target_compile_options(scree_options INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:${warnings} -ffp-contract=off -fno-math-errno -fno-semantic-interposition>)
if(SCREE_SANITIZE)
  # Lines are all that a report names: the rest of what a debugger reads costs a third of the compiler's time.
  # Not `null`: Debian's Thrust 1.17 binds a reference to *nullptr for empty ranges (reference.h:330). Nor the warning:
  # with sanitizers g++ gives it for initialised variables too, as its manual says. Nor `alignment` by g++, which takes
  # a third of the time of the build and of the tests: the fuzzers' build by clang has it, and bytes from outside become
  # numbers in what that build runs.
  target_compile_options(scree_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=address,undefined -fno-sanitize=null -fno-sanitize-recover=all
      -fno-omit-frame-pointer -g1 $<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=alignment -Wno-maybe-uninitialized>>)
  target_link_options(scree_options INTERFACE -fsanitize=address,undefined)
endif()
if(SCREE_TSAN)
  # With sanitizers g++ warns of initialised variables too.
  target_compile_options(scree_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=thread -fno-omit-frame-pointer
      $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>>)
  target_link_options(scree_options INTERFACE -fsanitize=thread)
endif()
if(SCREE_FUZZ)
  # What is run is to be seen by the fuzzer; and hostile numbers are cast, which `undefined` does not look at.
  target_compile_options(scree_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link,float-cast-overflow>)
  target_link_options(scree_options INTERFACE -fsanitize=float-cast-overflow)
endif()

# scree_unite(TARGET...): a plain target whose sources are compiled eight at once in optimised builds, because g++ spends
# more than half of its time on their headers. Builds with sanitizers and for a debugger compile each source by itself,
# which shows that each includes what it needs.
function(scree_unite)
  if(CMAKE_BUILD_TYPE STREQUAL Release)
    set_target_properties(${ARGN} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# What runs once in a run, such as the keys of the scene language and the command line: a third of the compiler's time is
# saved, and no time of the run is lost.
set(scree_run_once $<$<NOT:$<CONFIG:Debug>>:-O1>)

# Sources by what they need of the build. All but those that these two functions name are compiled by the same command
# with and without nvcc, so that the compiler cache serves them to both builds; core/parallel_loops.hpp says what Host
# can do without Thrust.

# scree_space_sources(FILE...): sources of this folder that name every space of the build (SCREE_SPACES,
# SCREE_FOR_EACH_SPACE).
function(scree_space_sources)
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_DEFINITIONS SCREE_WITH_CUDA=$<BOOL:${SCREE_CUDA}>)
endfunction()

# scree_parallel_sources(FILE...): sources of this folder that reach Thrust (core/parallel.hpp). They are compiled as
# CUDA where the build has nvcc and as C++ where it has not, unchanged.
function(scree_parallel_sources)
  scree_space_sources(${ARGN})
  if(SCREE_CUDA)
    set_property(SOURCE ${ARGN} PROPERTY LANGUAGE CUDA)
    set(options -std=c++20 --expt-relaxed-constexpr -diag-suppress=20012 --fmad=false -t2
      -Xcompiler=-Wall,-Wextra,-Wshadow,-Werror,-ffp-contract=off,-fno-math-errno,-fno-semantic-interposition)
  else()
    set(options -DTHRUST_DEVICE_SYSTEM=THRUST_DEVICE_SYSTEM_TBB)
    if(NOT SCREE_THRUST_INCLUDE IN_LIST CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES)
      list(APPEND options -isystem${SCREE_THRUST_INCLUDE})
    endif()
  endif()
  set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS ${options})
endfunction()
