// rejected by clang-diagnostic-unused-variable
void idle() { int unused = 1; }
