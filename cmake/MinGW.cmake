# SPDX-License-Identifier: MIT
# cmake --toolchain cmake/MinGW.cmake -DSHUTTER_EMBEDDING_ONLY=ON ...
# Builds for 64-bit Windows by MinGW-w64 (Debian and Ubuntu: g++-mingw-w64-x86-64-posix). Headers of
# Vulkan, fmt and glm do not depend on the system, and no Vulkan library is linked to: those of this
# machine are used.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
# Without a copy of the compiler's runtime for each program.
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -static)
