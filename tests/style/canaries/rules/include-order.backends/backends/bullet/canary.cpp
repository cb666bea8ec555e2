#include <repel/robots/arm.hpp>
