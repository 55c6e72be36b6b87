/* SPDX-License-Identifier: MIT
 * loads_plugin PLUGIN METHOD...: runs the host that is in a shared object. */
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

int main(int count, char** arguments) {
    int (*run)(int, char**) = NULL;
    void* const plugin = count > 1 ? dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL) : NULL;
    void* const found = plugin ? dlsym(plugin, "runHost") : NULL;
    if (!found) {
        fprintf(stderr, "loads_plugin: %s\n", dlerror());
        return 1;
    }
    memcpy(&run, &found, sizeof(run)); /* C has no cast from an object to a function */
    return run(count - 2, arguments + 2);
}
