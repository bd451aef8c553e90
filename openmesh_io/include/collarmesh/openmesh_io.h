#pragma once

#include "collarmesh/openmesh_io/read_om.h"
