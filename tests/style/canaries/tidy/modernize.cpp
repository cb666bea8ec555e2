// rejected by modernize-use-nullptr
int* nothing() { return 0; }
