# Scotch, which divides meshes among ranks (package libscotch-dev). Optional.
option(COLLARMESH_SCOTCH "Partition meshes where Scotch is found" ${PROJECT_IS_TOP_LEVEL})

set(COLLARMESH_HAS_SCOTCH OFF)
if(COLLARMESH_SCOTCH)
  find_library(COLLARMESH_SCOTCH_LIBRARY scotch)
  find_library(COLLARMESH_SCOTCH_ERRORS_LIBRARY scotcherr)
  find_path(COLLARMESH_SCOTCH_INCLUDE_DIR scotch.h PATH_SUFFIXES scotch)
  if(COLLARMESH_SCOTCH_LIBRARY AND COLLARMESH_SCOTCH_ERRORS_LIBRARY AND COLLARMESH_SCOTCH_INCLUDE_DIR)
    set(COLLARMESH_HAS_SCOTCH ON)
  endif()
endif()
message(STATUS "Partitions by Scotch: ${COLLARMESH_HAS_SCOTCH}")
