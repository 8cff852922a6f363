# Finds OpenSubdiv's library for the processor: Debian's own CMake configuration asks for static libraries that its
# package does not hold. Defines OpenSubdiv::osdCPU.
find_path(OpenSubdiv_INCLUDE_DIR opensubdiv/far/topologyRefiner.h)
find_library(OpenSubdiv_LIBRARY osdCPU)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenSubdiv REQUIRED_VARS OpenSubdiv_LIBRARY OpenSubdiv_INCLUDE_DIR)
if(OpenSubdiv_FOUND AND NOT TARGET OpenSubdiv::osdCPU)
  add_library(OpenSubdiv::osdCPU INTERFACE IMPORTED)
  set_target_properties(OpenSubdiv::osdCPU PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${OpenSubdiv_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${OpenSubdiv_LIBRARY}")
endif()
