// rejected by concurrency-mt-unsafe
#include <cstdlib>
int roll() { return std::rand(); }
