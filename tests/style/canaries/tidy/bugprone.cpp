// rejected by bugprone-integer-division
double half() { return 1 / 2; }
