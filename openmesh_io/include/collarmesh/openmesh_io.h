#pragma once

#include "collarmesh/openmesh_io/boundary_surface.h"
#include "collarmesh/openmesh_io/read_om.h"
#include "collarmesh/openmesh_io/surfaces.h"
#include "collarmesh/openmesh_io/write_om.h"
