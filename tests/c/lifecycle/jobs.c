/* Jobs: started, polled, waited for, cancelled, failed, and solved again. */

#include "lifecycle.h"

void jobs(const wovenfit_mesh *mesh) {
    wovenfit_design *design = limb_design(mesh, 1.5);
    wovenfit_parameters *values = NULL;
    wovenfit_job *job = NULL, *again = NULL, *cancelled = NULL;
    wovenfit_prepared *prepared = NULL;
    wovenfit_result *first = NULL, *second = NULL;
    wovenfit_job_progress progress;
    wovenfit_error *error = NULL;
    DONE(wovenfit_parameters_new(&values, &error));
    REFUSED(wovenfit_job_start(NULL, design, NULL, &job, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`mesh`");
    REFUSED(wovenfit_job_start(mesh, NULL, NULL, &job, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`design`");
    REFUSED(wovenfit_job_start(mesh, design, NULL, NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`job`");
    DONE(wovenfit_parameters_set(values, "units", "cm", &error));
    REFUSED(wovenfit_job_start(mesh, design, values, &job, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`units`");
    DONE(wovenfit_parameters_set(values, "units", "auto", &error));
    CHECK(job == NULL);

    DONE(wovenfit_job_start(mesh, design, values, &job, &error));
    DONE(wovenfit_job_poll(job, &progress, &error));
    CHECK(progress.state <= WOVENFIT_JOB_STATE_DONE && progress.fraction >= 0);
    CHECK(wovenfit_job_wait(job, 0.0, NULL) != WOVENFIT_STATUS_INTERNAL);
    REFUSED(wovenfit_job_wait(job, NAN, &error), WOVENFIT_STATUS_INVALID_ARGUMENT, "`seconds`");
    DONE(wovenfit_job_wait(job, -1.0, &error));
    DONE(wovenfit_job_wait(job, 1e300, &error));
    DONE(wovenfit_job_poll(job, &progress, &error));
    CHECK(progress.state == WOVENFIT_JOB_STATE_DONE && progress.stage == WOVENFIT_JOB_STAGE_REPORT);
    CHECK(progress.energy > 0);
    DONE(wovenfit_job_result(job, &first, &error));
    DONE(wovenfit_job_prepared(job, &prepared, &error));
    /* Cancelling what has ended changes nothing; the result outlives its job. */
    DONE(wovenfit_job_cancel(job, &error));
    DONE(wovenfit_job_result(job, &second, &error));
    wovenfit_result_free(second);
    wovenfit_job_free(job);
    results(first);

    /* The same design from the earlier result is the same pattern but for the last digits; another
     * pressure is another. */
    wovenfit_design *other = limb_design(mesh, 2.0);
    DONE(wovenfit_job_start_prepared(prepared, first, other, values, &again, &error));
    wovenfit_design_free(other);
    DONE(wovenfit_job_wait(again, -1.0, &error));
    DONE(wovenfit_job_result(again, &second, &error));
    wovenfit_pressure pressure;
    DONE(wovenfit_result_pressure(second, 0, &pressure, &error));
    CHECK(fabs(pressure.asked_kpa - 2.0) < 1e-12 && pressure.met == 1);
    wovenfit_prepared *same = NULL;
    DONE(wovenfit_result_prepared(second, &same, &error));
    wovenfit_prepared_free(same);
    wovenfit_job_free(again);

    /* Another region needs another preparation. */
    DONE(wovenfit_design_add_region_plane(design, (const double[]){0, 0, 20},
                                          (const double[]){0, 0, 1}, &error));
    DONE(wovenfit_job_start_prepared(prepared, NULL, design, values, &again, &error));
    DONE(wovenfit_job_wait(again, -1.0, &error));
    wovenfit_result *none = NULL;
    REFUSED(wovenfit_job_result(again, &none, &error), WOVENFIT_STATUS_PREPARED_FOR_ANOTHER,
            "`region`");
    CHECK(none == NULL);
    wovenfit_job_free(again);
    /* And its result is of another limb. */
    DONE(wovenfit_job_start(mesh, design, values, &job, &error));
    DONE(wovenfit_job_wait(job, -1.0, &error));
    DONE(wovenfit_job_result(job, &none, &error));
    REFUSED(wovenfit_job_start_prepared(prepared, none, design, values, &again, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "another prepared limb");
    double *corners = NULL;
    size_t count = 0, missing = 0;
    corners = doubles(none, WOVENFIT_RESULT_ARRAY_GIVEN_PATTERN_PER_CORNER, &count);
    for (size_t k = 0; k < count; k++) missing += isnan(corners[k]) ? 1 : 0;
    CHECK(missing > 0 && missing < count / 2);
    free(corners);
    wovenfit_result_free(none);
    wovenfit_job_free(job);

    /* A job that fails says why, and keeps its prepared limb. */
    wovenfit_design_free(design);
    design = limb_design(mesh, 1.5);
    DONE(wovenfit_design_add_pressures(design, (const double[]){500, 0, 0}, (const double[]){1}, 1,
                                       &error));
    DONE(wovenfit_job_start(mesh, design, NULL, &job, &error));
    DONE(wovenfit_job_wait(job, -1.0, &error));
    DONE(wovenfit_job_poll(job, &progress, &error));
    CHECK(progress.state == WOVENFIT_JOB_STATE_FAILED);
    REFUSED(wovenfit_job_result(job, &none, &error), WOVENFIT_STATUS_PRESSURE, "pressure 2");
    wovenfit_prepared_free(prepared);
    DONE(wovenfit_job_prepared(job, &prepared, &error));
    wovenfit_job_free(job);
    REFUSED(wovenfit_job_start_prepared(NULL, NULL, design, NULL, &job, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`prepared`");

    /* Cancelled before it can have ended, and freed while it runs. */
    DONE(wovenfit_parameters_set(values, "method", "diffusion", &error));
    DONE(wovenfit_parameters_set(values, "spacing", "2", &error));
    wovenfit_design_free(design);
    design = limb_design(mesh, 1.5);
    DONE(wovenfit_job_start(mesh, design, values, &cancelled, &error));
    REFUSED(wovenfit_job_result(cancelled, &none, &error), WOVENFIT_STATUS_NOT_READY, "still runs");
    REFUSED(wovenfit_job_wait(cancelled, 0.0, &error), WOVENFIT_STATUS_TIMEOUT, "still runs");
    DONE(wovenfit_job_cancel(cancelled, &error));
    DONE(wovenfit_job_wait(cancelled, -1.0, &error));
    DONE(wovenfit_job_poll(cancelled, &progress, &error));
    CHECK(progress.state == WOVENFIT_JOB_STATE_CANCELLED);
    REFUSED(wovenfit_job_result(cancelled, &none, &error), WOVENFIT_STATUS_CANCELLED, "cancelled");
    wovenfit_job_free(cancelled);
    DONE(wovenfit_job_start(mesh, design, values, &cancelled, &error));
    wovenfit_job_free(cancelled);

    REFUSED(wovenfit_job_poll(NULL, &progress, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`job`");
    REFUSED(wovenfit_job_cancel(NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`job`");
    REFUSED(wovenfit_job_wait(NULL, 0, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`job`");
    REFUSED(wovenfit_job_prepared(NULL, &prepared, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`job`");
    wovenfit_prepared_free(prepared);
    wovenfit_parameters_free(values);
    wovenfit_design_free(design);
    wovenfit_result_free(first);
    wovenfit_result_free(second);
}
