#pragma once

// Headers that nearly every test includes, compiled once.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "collarmesh/check.h"
#include "collarmesh/mesher.h"
#include "collarmesh/plc_builder.h"
