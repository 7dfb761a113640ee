# CPack: the packages snug, snug-check, snug-research, libsnug-dev and, where the module is built, python3-snug. `make deb` sets the flags and the date.

set(SNUG_PACKAGER "snug developers <snug@packages.invalid>" CACHE STRING "Maintainer of the packages: Name <address>")
set(SNUG_PACKAGE_REVISION 1 CACHE STRING "Debian revision")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME snug)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # which CPack would put before every description
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENTS_ALL command check research development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${SNUG_PACKAGE_REVISION})
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${SNUG_PACKAGER}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/before_packing.cmake)

set(about "Answers questions about the limit surfaces of subdivision meshes (Loop,
Catmull-Clark, Doo-Sabin, Midedge) and proves the answers: whether two parts
touch, how far apart they are, what encloses them, where rays hit them.")

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME snug)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION math)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "bash-completion, snug-check, snug-research")
set(CPACK_DEBIAN_COMMAND_DESCRIPTION "proved answers about subdivision surfaces - command
${about}
.
This package has the command snug, its manual pages, its completion in bash,
and the page for browsers that snug view fills.")

set(CPACK_DEBIAN_CHECK_PACKAGE_NAME snug-check)
set(CPACK_DEBIAN_CHECK_PACKAGE_SECTION math)
set(CPACK_DEBIAN_CHECK_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CHECK_PACKAGE_SUGGESTS snug)
set(CPACK_DEBIAN_CHECK_DESCRIPTION "proved answers about subdivision surfaces - checker of proofs
${about}
.
This package has the program snug-check, which verifies the proofs that snug
writes with its answers, and shares no code with it.")

set(CPACK_DEBIAN_RESEARCH_PACKAGE_NAME snug-research)
set(CPACK_DEBIAN_RESEARCH_PACKAGE_SECTION math)
set(CPACK_DEBIAN_RESEARCH_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RESEARCH_PACKAGE_SUGGESTS "snug, bash-completion")
set(CPACK_DEBIAN_RESEARCH_DESCRIPTION "proved answers about subdivision surfaces - nodal functions
${about}
.
This package has the command snug-research: which nodal functions are linearly
independent, their tables and weights, fits to points, and the measurements of
the dissertation repeated; with manual pages and completion in bash.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsnug-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libhwy-dev, zlib1g-dev, libstdc++-12-dev | libstdc++-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "snug, libosd-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "proved answers about subdivision surfaces - C++ library
${about}
.
This package has the C++20 headers, the static library, and the files that
CMake and pkg-config find it by. The header for OpenSubdiv needs libosd-dev.")

# The target of python/, with what lies in python/snug, to where Debian's Python looks.
if(TARGET snug_python)
  set(python_packages lib/python3/dist-packages)
  install(TARGETS snug_python LIBRARY DESTINATION ${python_packages}/snug COMPONENT python)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/snug DESTINATION ${python_packages} COMPONENT python
          FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
  install(FILES ${PROJECT_SOURCE_DIR}/web/page/still.html DESTINATION ${python_packages}/snug COMPONENT python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-snug)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  execute_process(COMMAND /usr/bin/python3 -c "import sys; print(sys.version_info.minor, sys.version_info.minor + 1)"
                  OUTPUT_VARIABLE minors OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(minors)
  list(GET minors 0 minor)
  list(GET minors 1 next_minor)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= 3.${minor}~), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS snug)  # for the page that snug.view() fills
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "proved answers about subdivision surfaces - Python module
${about}
.
This package has the module snug for Python 3, with arrays of numpy.")
endif()

# What Debian wants below /usr/share/doc/PACKAGE: the changelogs of the project and of the package, and the copyright.
set(documents ${CMAKE_CURRENT_BINARY_DIR}/documents)
add_custom_command(
  OUTPUT ${documents}/changelog.gz ${documents}/changelog.Debian.gz
  COMMAND ${CMAKE_CURRENT_LIST_DIR}/changelogs ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${documents}
          ${PROJECT_VERSION}-${SNUG_PACKAGE_REVISION} ${SNUG_PACKAGER}
  DEPENDS changelogs ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM)
add_custom_target(snug_changelogs ALL DEPENDS ${documents}/changelog.gz)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES ${documents}/changelog.gz ${documents}/changelog.Debian.gz ${CMAKE_CURRENT_LIST_DIR}/copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME} COMPONENT ${component})
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/overrides/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT ${component})
endforeach()

include(CPack)
