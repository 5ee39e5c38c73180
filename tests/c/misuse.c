/* Two threads change one design at once, which the header forbids: a run under a race detector must
 * say so, or it would not say anything of the library's own races either. */

#include <pthread.h>

#include "limb.h"

int checks = 0;

static pthread_barrier_t together;

static void *change(void *design) {
    pthread_barrier_wait(&together);
    for (int i = 0; i < 200; i++)
        wovenfit_design_set_number(design, "fabric.warp", 0.5 + 0.001 * i, NULL);
    return NULL;
}

int main(void) {
    wovenfit_mesh *mesh = limb_mesh();
    wovenfit_design *design = limb_design(mesh, 1.0);
    pthread_t threads[2];
    CHECK(pthread_barrier_init(&together, NULL, 2) == 0);
    for (int i = 0; i < 2; i++) CHECK(pthread_create(threads + i, NULL, change, design) == 0);
    for (int i = 0; i < 2; i++) CHECK(pthread_join(threads[i], NULL) == 0);
    wovenfit_design_free(design);
    wovenfit_mesh_free(mesh);
    return 0;
}
