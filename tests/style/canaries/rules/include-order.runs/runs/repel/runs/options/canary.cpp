// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/engine/run.hpp>
