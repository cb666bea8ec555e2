# Filled in below: install rules, the package file and the pkg-config file.
