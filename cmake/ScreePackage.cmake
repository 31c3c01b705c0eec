# The Debian packages: the components below, which `cmake --install BUILD` leaves out because the folder that it makes
# (ScreeInstall.cmake) has other places; `cmake --install BUILD --component NAME --prefix DIR` installs one of them.
# scripts/package.sh builds the target `manual`, and calls cpack.
include(GNUInstallDirs)

# Debian's libraries are where every program looks, so the path of the portable folder goes.
set(libdir ${CMAKE_INSTALL_LIBDIR})
if(CMAKE_LIBRARY_ARCHITECTURE)
  set(libdir lib/${CMAKE_LIBRARY_ARCHITECTURE})
endif()
scree_install_library(${libdir} "COMPONENT;library;EXCLUDE_FROM_ALL" "COMPONENT;development;EXCLUDE_FROM_ALL")
install(CODE "file(RPATH_REMOVE FILE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${libdir}/libscree.so.${PROJECT_VERSION}\")"
        COMPONENT library EXCLUDE_FROM_ALL)
install(TARGETS scree RUNTIME COMPONENT program EXCLUDE_FROM_ALL)
install(CODE "file(RPATH_REMOVE FILE \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/scree\")"
        COMPONENT program EXCLUDE_FROM_ALL)

install(DIRECTORY configs DESTINATION ${CMAKE_INSTALL_DATADIR}/scree COMPONENT scenes EXCLUDE_FROM_ALL)

install(FILES packaging/scree.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME scree
        COMPONENT completion EXCLUDE_FROM_ALL)
install(FILES packaging/scree.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _scree
        COMPONENT completion EXCLUDE_FROM_ALL)
install(FILES packaging/scree.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT completion EXCLUDE_FROM_ALL)

# Who answers for the package: the first author of CITATION.cff. A package needs an address, and the project has none that
# is public, so whoever hands packages on gives theirs.
set(SCREE_MAINTAINER_EMAIL scree@maintainers.invalid CACHE STRING "Address in the package's Maintainer field")
file(STRINGS CITATION.cff author LIMIT_COUNT 1 REGEX "^  - name: ")
string(REGEX REPLACE "^  - name: *\"(.*)\"$" "\\1 <${SCREE_MAINTAINER_EMAIL}>" CPACK_PACKAGE_CONTACT "${author}")
# The date of the commit, not of the build.
execute_process(COMMAND git log -1 --format=%cD WORKING_DIRECTORY ${CMAKE_SOURCE_DIR}
                OUTPUT_VARIABLE SCREE_CHANGELOG_DATE OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT SCREE_CHANGELOG_DATE) # outside git
  string(TIMESTAMP SCREE_CHANGELOG_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
set(SCREE_DEBIAN_VERSION ${PROJECT_VERSION}-1)
configure_file(packaging/changelog.Debian.in package/changelog.Debian @ONLY)

# The manual page, from the program's own help and packaging/scree.h2m; texts packed without names and dates.
set(texts ${CMAKE_BINARY_DIR}/package)
add_custom_target(manual
  COMMAND help2man --no-info --help-option=--help-all --include ${CMAKE_SOURCE_DIR}/packaging/scree.h2m
          --manual "User Commands" --source "scree ${PROJECT_VERSION}" --output ${texts}/scree.1 $<TARGET_FILE:scree>
  COMMAND ${CMAKE_COMMAND} -E copy ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${texts}/changelog
  COMMAND gzip --force --keep --best --no-name ${texts}/scree.1 ${texts}/changelog ${texts}/changelog.Debian
  DEPENDS scree VERBATIM)
install(FILES ${texts}/scree.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT manual EXCLUDE_FROM_ALL)

install(FILES ${texts}/changelog.gz README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/scree
        COMPONENT documentation EXCLUDE_FROM_ALL)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/scree COMPONENT documentation EXCLUDE_FROM_ALL)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libscree-dev
        COMPONENT development EXCLUDE_FROM_ALL)

# Three packages: the program with all that a user of it needs, and, as Debian has it for libraries, one that is named after
# what programs are linked against, and one to build them with.
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(library_package libscree${SCREE_ABI_VERSION})
# scree_package(GROUP NAME SECTION DEPENDS DESCRIPTION COMPONENTS...): a package of these components, and of the texts that
# each package has. DESCRIPTION begins with the line that is shown in lists.
macro(scree_package group name section depends description)
  install(FILES ${texts}/changelog.Debian.gz packaging/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${group}_texts EXCLUDE_FROM_ALL)
  foreach(part ${group}_texts ${ARGN})
    list(APPEND CPACK_COMPONENTS_ALL ${part})
    string(TOUPPER ${part} part)
    set(CPACK_COMPONENT_${part}_GROUP ${group})
  endforeach()
  string(TOUPPER ${group} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${description}")
endmacro()
set(what "scree reads a scene in YAML and computes how spheres and boxes fall, collide,
slide, roll and come to rest.")
# The program sees the inside of the library, which is the same in no two versions.
scree_package(program_package scree science "${library_package} (= ${SCREE_DEBIAN_VERSION})"
"offline simulator of rigid particles
${what} It writes images, a film, a table of measures
and a page that says how far to trust the run: each run audits its own
energy, and a scene can hold checks of its own.

It runs offline, on the processor or, where it was built with CUDA, on an
NVIDIA GPU, and needs no display. The same scene gives the same bits for any
number of threads." program scenes completion manual documentation)
scree_package(library_package ${library_package} libs ""
"simulator of rigid particles - library
${what}

This is the library that the program scree, and programs of others, are
linked against." library)
scree_package(development_package libscree-dev libdevel
  "${library_package} (= ${SCREE_DEBIAN_VERSION})"
"simulator of rigid particles - development files
${what}

These are the headers, what CMake and pkg-config need to find the library,
and an example: a program loads a scene, takes its steps and reads the state." development)

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # CPack would put one line above the first of each

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR}/lib)
# Which package the library's name stands for, and that the loader has to look again.
file(WRITE ${texts}/shlibs "libscree ${SCREE_ABI_VERSION} ${library_package} (>= ${SCREE_DEBIAN_VERSION})\n")
file(WRITE ${texts}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_PACKAGE_CONTROL_EXTRA ${texts}/shlibs ${texts}/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# Programs that scree runs, and does without: the film, and the plots.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_PACKAGE_RECOMMENDS "ffmpeg, gnuplot-nox")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_PACKAGE_SUGGESTS "paraview")
include(CPack)
