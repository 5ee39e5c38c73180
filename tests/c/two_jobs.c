/* Two jobs at once on one mesh, each started by a thread of its own, watched by a second one; a third
 * job cancelled from another thread than it was started on; one result read by two threads. */

#include <pthread.h>

#include "limb.h"

int checks = 0;

/* What a thread is given; each checks on its own and never touches `checks`. */
struct work {
    const wovenfit_mesh *mesh;
    double kpa;
    wovenfit_job *job;
    wovenfit_result *result;
    wovenfit_status status;
    double got;
    uint64_t sum;
};

static void *start_and_wait(void *given) {
    struct work *work = given;
    const uint32_t vertex = (RINGS / 2) * SIDES + 3;
    wovenfit_design *design = NULL;
    wovenfit_pressure pressure;
    work->status = wovenfit_design_new(1.0, &design, NULL);
    if (work->status == WOVENFIT_STATUS_OK)
        work->status = wovenfit_design_add_pressures_at_vertices(design, work->mesh, &vertex,
                                                                 &work->kpa, 1, NULL);
    wovenfit_job *job = NULL;
    if (work->status == WOVENFIT_STATUS_OK)
        work->status = wovenfit_job_start(work->mesh, design, NULL, &job, NULL);
    wovenfit_design_free(design);
    if (work->status == WOVENFIT_STATUS_OK) work->status = wovenfit_job_wait(job, -1.0, NULL);
    if (work->status == WOVENFIT_STATUS_OK)
        work->status = wovenfit_job_result(job, &work->result, NULL);
    wovenfit_job_free(job);
    if (work->status == WOVENFIT_STATUS_OK)
        work->status = wovenfit_result_pressure(work->result, 0, &pressure, NULL);
    work->got = pressure.got_kpa;
    return NULL;
}

/* Polls a job until it has ended. */
static void *watch(void *given) {
    struct work *work = given;
    wovenfit_job_progress progress;
    do {
        work->status = wovenfit_job_wait(work->job, 0.002, NULL);
        wovenfit_status polled = wovenfit_job_poll(work->job, &progress, NULL);
        if (polled != WOVENFIT_STATUS_OK) work->status = polled;
    } while (work->status == WOVENFIT_STATUS_TIMEOUT);
    work->got = progress.state;
    return NULL;
}

static void *cancel(void *given) {
    struct work *work = given;
    work->status = wovenfit_job_cancel(work->job, NULL);
    return NULL;
}

/* Reads what a result makes when it is first asked for. */
static void *read_result(void *given) {
    struct work *work = given;
    const int32_t arrays[] = {WOVENFIT_RESULT_ARRAY_GIVEN_PATTERN_PER_CORNER,
                              WOVENFIT_RESULT_ARRAY_GIVEN_PRESSURE_KPA};
    work->sum = 0;
    for (int i = 0; i < 2; i++) {
        size_t count = 0;
        work->status = wovenfit_result_doubles(work->result, arrays[i], NULL, 0, &count, NULL);
        double *values = malloc(count * sizeof *values);
        if (values == NULL || work->status != WOVENFIT_STATUS_OK) return NULL;
        work->status = wovenfit_result_doubles(work->result, arrays[i], values, count, &count, NULL);
        for (size_t k = 0; k < count; k++) {
            uint64_t bits;
            memcpy(&bits, values + k, sizeof bits);
            work->sum = 31 * work->sum + bits;
        }
        free(values);
    }
    size_t needed = 0;
    work->status = wovenfit_result_text(work->result, WOVENFIT_RESULT_FILE_WORN_OBJ, NULL, 0, &needed,
                                        NULL);
    work->sum = 31 * work->sum + needed;
    return NULL;
}

static void both(void *(*one)(void *), struct work *a, void *(*other)(void *), struct work *b) {
    pthread_t first, second;
    CHECK(pthread_create(&first, NULL, one, a) == 0);
    CHECK(pthread_create(&second, NULL, other, b) == 0);
    CHECK(pthread_join(first, NULL) == 0);
    CHECK(pthread_join(second, NULL) == 0);
    CHECK(a->status == WOVENFIT_STATUS_OK && b->status == WOVENFIT_STATUS_OK);
}

int main(void) {
    wovenfit_error *error = NULL;
    wovenfit_mesh *mesh = limb_mesh();
    struct work soft = {.mesh = mesh, .kpa = 1.0}, firm = {.mesh = mesh, .kpa = 2.0};
    both(start_and_wait, &soft, start_and_wait, &firm);
    CHECK(fabs(soft.got - 1.0) < 0.01 && fabs(firm.got - 2.0) < 0.02);

    struct work one = {.result = soft.result}, two = {.result = soft.result};
    both(read_result, &one, read_result, &two);
    CHECK(one.sum == two.sum && one.sum != 0);

    /* The paper's method with fine threads takes long enough to be cancelled. */
    wovenfit_parameters *slow = NULL;
    wovenfit_design *design = limb_design(mesh, 1.5);
    wovenfit_job *job = NULL;
    DONE(wovenfit_parameters_new(&slow, &error));
    DONE(wovenfit_parameters_set(slow, "method", "diffusion", &error));
    DONE(wovenfit_parameters_set(slow, "spacing", "3", &error));
    DONE(wovenfit_job_start(mesh, design, slow, &job, &error));
    struct work watching = {.job = job}, cancelling = {.job = job};
    both(watch, &watching, cancel, &cancelling);
    CHECK(watching.got == WOVENFIT_JOB_STATE_CANCELLED);

    wovenfit_job_free(job);
    wovenfit_parameters_free(slow);
    wovenfit_design_free(design);
    wovenfit_result_free(soft.result);
    wovenfit_result_free(firm.result);
    wovenfit_mesh_free(mesh);
    printf("%d checks\n", checks);
    return 0;
}
