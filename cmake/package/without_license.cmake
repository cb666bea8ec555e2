# SPDX-License-Identifier: BSD-3-Clause
# Run by cpack before it makes the package.
file(GLOB_RECURSE licenses ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*/doc/*/LICENSE)
if(licenses)
  file(REMOVE ${licenses})
endif()
