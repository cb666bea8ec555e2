// rejected by cppcoreguidelines-avoid-non-const-global-variables
int counter = 0;
