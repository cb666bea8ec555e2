// rejected by misc-redundant-expression
bool never(int a) { return a < a; }
