// rejected by readability-identifier-naming
struct lower_case {};
