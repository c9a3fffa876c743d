# What the program and its tests use beyond the libraries: files, pictures, the command line.
find_package(HDF5 1.10 REQUIRED COMPONENTS C)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(pugixml REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(SNDFILE REQUIRED IMPORTED_TARGET sndfile)  # no CMake package in Debian
find_package(GTest REQUIRED)
include(GoogleTest)
find_package(VTK 9.1 REQUIRED COMPONENTS
  CommonCore CommonDataModel CommonExecutionModel FiltersCore FiltersSources FiltersGeometry
  IOCore IOXML IOImage ImagingCore RenderingCore RenderingOpenGL2 RenderingAnnotation RenderingFreeType)
find_package(OpenImageIO 2.4 REQUIRED)
# Debian's export names an OpenCV include folder that is absent without libopencv-dev.
foreach(target OpenImageIO::OpenImageIO OpenImageIO::OpenImageIO_Util)
  get_target_property(folders ${target} INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER folders EXCLUDE REGEX "opencv4")
  set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${folders}")
endforeach()
