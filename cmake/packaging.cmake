# What is installed besides the libraries, in three components (program, dev, doc), and the Debian packages made of them:
# geoprior, libgeoprior-dev, geoprior-doc. scripts/package.sh makes and tries them. A program <prefix>/bin/geoprior finds
# <prefix>/share/geoprior by itself (testbed/home.h), so that any prefix will do.
install(TARGETS geoprior RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS geoprior_images LIBRARY DESTINATION lib/geoprior COMPONENT program)
install(DIRECTORY experiments DESTINATION share/geoprior COMPONENT program
  PATTERN "*.cpp" EXCLUDE PATTERN "*.h" EXCLUDE PATTERN CMakeLists.txt EXCLUDE PATTERN __pycache__ EXCLUDE)
install(DIRECTORY results DESTINATION share/geoprior COMPONENT program
  REGEX "/results/runs$" EXCLUDE PATTERN __pycache__ EXCLUDE PATTERN "*.egg-info" EXCLUDE)
# The models come from Debian packages, converted by scripts/convert_data.sh; their licences allow it
# (cmake/debian/copyright), and an installation that converts them itself would need 100 MB of other packages.
install(CODE "
  if(NOT EXISTS \"${PROJECT_SOURCE_DIR}/data/human.glb\")
    message(FATAL_ERROR \"data/ has no models: scripts/setup.sh converts them\")
  endif()" COMPONENT program)
install(DIRECTORY data DESTINATION share/geoprior COMPONENT program
  FILES_MATCHING PATTERN "*.glb" PATTERN "*.off" PATTERN banks EXCLUDE)
install(CODE "execute_process(COMMAND find \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/geoprior\" -type d -empty -delete)"
  COMPONENT program)

# What the program says of itself, written when it is installed.
set(GEOPRIOR_PACKAGE_DIR ${PROJECT_BINARY_DIR}/package)
install(CODE "
  function(geoprior_ask target)
    execute_process(COMMAND \"$<TARGET_FILE:geoprior>\" \${ARGN} OUTPUT_FILE \${target} RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR \"geoprior \${ARGN}: \${failed}\")
    endif()
  endfunction()
  file(MAKE_DIRECTORY ${GEOPRIOR_PACKAGE_DIR})
  geoprior_ask(${GEOPRIOR_PACKAGE_DIR}/geoprior completion bash)
  geoprior_ask(${GEOPRIOR_PACKAGE_DIR}/_geoprior completion zsh)
  geoprior_ask(${GEOPRIOR_PACKAGE_DIR}/geoprior.fish completion fish)
  geoprior_ask(${GEOPRIOR_PACKAGE_DIR}/geoprior.1 manual)
  execute_process(COMMAND gzip -9nf ${GEOPRIOR_PACKAGE_DIR}/geoprior.1 COMMAND_ERROR_IS_FATAL ANY)" COMPONENT program)
install(FILES ${GEOPRIOR_PACKAGE_DIR}/geoprior DESTINATION share/bash-completion/completions COMPONENT program)
install(FILES ${GEOPRIOR_PACKAGE_DIR}/_geoprior DESTINATION share/zsh/vendor-completions COMPONENT program)
install(FILES ${GEOPRIOR_PACKAGE_DIR}/geoprior.fish DESTINATION share/fish/vendor_completions.d COMPONENT program)
install(FILES ${GEOPRIOR_PACKAGE_DIR}/geoprior.1.gz DESTINATION share/man/man1 COMPONENT program)

install(DIRECTORY docs DESTINATION share/doc/geoprior-doc COMPONENT doc)
install(FILES README.md LICENSE DESTINATION share/doc/geoprior-doc COMPONENT doc)

# geoprior_package(component name): copyright and changelogs, which every Debian package has.
# No mail arrives there: the domain is one of those reserved for examples (RFC 2606). Who hands packages on puts theirs.
set(GEOPRIOR_MAINTAINER "geoprior developers <geoprior@geoprior.example>")
set(GEOPRIOR_RELEASE 1)
function(geoprior_package component name)
  set(folder ${GEOPRIOR_PACKAGE_DIR}/doc/${name})
  install(CODE "
    string(TIMESTAMP date \"%a, %d %b %Y %H:%M:%S +0000\" UTC)
    file(WRITE ${folder}/changelog.Debian \"geoprior (${PROJECT_VERSION}-${GEOPRIOR_RELEASE}) unstable; urgency=medium

  * Package of this version, made by cpack.

 -- ${GEOPRIOR_MAINTAINER}  \${date}\\n\")
    configure_file(${PROJECT_SOURCE_DIR}/CHANGELOG.md ${folder}/changelog COPYONLY)
    execute_process(COMMAND gzip -9nf ${folder}/changelog ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT ${component})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright ${folder}/changelog.gz ${folder}/changelog.Debian.gz
    DESTINATION share/doc/${name} COMPONENT ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
endfunction()
geoprior_package(program geoprior)
geoprior_package(dev libgeoprior-dev)
geoprior_package(doc geoprior-doc)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME geoprior)
set(CPACK_PACKAGE_CONTACT ${GEOPRIOR_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL program dev doc)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${GEOPRIOR_RELEASE})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS
  "python3, python3-h5py, python3-matplotlib, python3-numpy, xvfb, libgl1-mesa-dri, fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, python3-rdflib")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "geoprior-doc, blender, assimp-testmodels, xtrkcad-common, python3-pandas")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "\
Methods for skinning, paper, sound, fluids, surface details, sketches,
assemblies and growing organs, each beside the baselines that people use
instead: on the same scene, measured by the same code, recorded to files that
other programs open.

This package has the program, compiled for processors of the level
${GEOPRIOR_ARCH}.")

set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "libeigen3-dev, libtbb-dev, libgmp-dev, libmpfr-dev, libsuitesparse-dev, libopenblas-dev, libfftw3-dev, liblemon-dev, \
libnauty2-dev, liblua5.4-dev, libserd-dev, libraptor2-dev, libceres-dev, libgoogle-glog-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "\
Methods, baselines and metrics without the program: static libraries, headers
and a CMake package, find_package(geoprior). They depend on Eigen, TBB and
what each method itself needs.")

set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_COMPONENT_DOC_DESCRIPTION "\
The documents: a page for each topic with its equations and what was found,
the formats of files, the keys of experiment files, and how to add methods,
metrics and topics.")
include(CPack)
