# collarmesh-mpi and its library, for meshes on many ranks, are built where PETSc is found, with the MPI and the HDF5
# that PETSc was built with (packages libpetsc-real-dev, libhdf5-openmpi-dev).
set(COLLARMESH_DISTRIBUTED AUTO CACHE STRING "Build collarmesh-mpi: AUTO (where PETSc is found), ON or OFF")
set_property(CACHE COLLARMESH_DISTRIBUTED PROPERTY STRINGS AUTO ON OFF)
set(COLLARMESH_HAS_DISTRIBUTED OFF)
if(COLLARMESH_DISTRIBUTED STREQUAL "ON" OR (COLLARMESH_DISTRIBUTED STREQUAL "AUTO" AND PROJECT_IS_TOP_LEVEL))
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND)
    pkg_check_modules(COLLARMESH_PETSC QUIET PETSc>=3.18 ompi-cxx)
    pkg_check_modules(COLLARMESH_PETSC_HDF5 QUIET hdf5-openmpi)
  endif()
  if(COLLARMESH_PETSC_FOUND AND COLLARMESH_PETSC_HDF5_FOUND)
    set(COLLARMESH_HAS_DISTRIBUTED ON)
  elseif(COLLARMESH_DISTRIBUTED STREQUAL "ON")
    message(FATAL_ERROR "COLLARMESH_DISTRIBUTED is ON, but PETSc 3.18 with MPI and HDF5 is not there (packages \
libpetsc-real-dev, libhdf5-openmpi-dev)")
  endif()
endif()
message(STATUS "Meshes on many ranks (collarmesh-mpi): ${COLLARMESH_HAS_DISTRIBUTED}")
