// rejected by bugprone-integer-division
#include "core/header.hpp"
