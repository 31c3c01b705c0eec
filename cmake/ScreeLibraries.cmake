# Everything scree takes from Debian; the reason for each is in docs/dependencies.md.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
target_include_directories(scree_options SYSTEM INTERFACE $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)

# Thrust: nvcc brings its own; without nvcc it is Debian's, unless another is named (the toolkit's
# include/cccl sorts twice as fast on the host). Never found by chance: two machines with the same packages build
# the same program.
if(NOT SCREE_CUDA)
  set(SCREE_THRUST_INCLUDE /usr/include CACHE PATH "Folder that holds thrust/version.h, for builds without nvcc")
  if(NOT EXISTS ${SCREE_THRUST_INCLUDE}/thrust/version.h)
    message(FATAL_ERROR "SCREE_THRUST_INCLUDE: no thrust/version.h in ${SCREE_THRUST_INCLUDE} (libthrust-dev)")
  endif()
endif()

find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Boost 1.74 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Freetype REQUIRED)
find_file(SCREE_FONT DejaVuSans.ttf PATHS /usr/share/fonts/truetype/dejavu NO_DEFAULT_PATH REQUIRED
          DOC "The font that is built into the program")
pkg_check_modules(ccd REQUIRED IMPORTED_TARGET ccd)
pkg_check_modules(egl REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(osmesa REQUIRED IMPORTED_TARGET osmesa)
pkg_check_modules(qhull REQUIRED IMPORTED_TARGET qhull_r)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial)
