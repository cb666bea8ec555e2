// rejected by clang-analyzer-core.NullDereference
int read() {
  int* nothing = nullptr;
  return *nothing;
}
