/* Walks a host's whole way through the ABI, and every way in which it is refused. */

#include "lifecycle.h"

int checks = 0;

void versions(void) {
    wovenfit_error *error = NULL;
    CHECK(wovenfit_abi_version() == WOVENFIT_ABI_VERSION);
    CHECK(strchr(wovenfit_version(), '.') != NULL);
    DONE(wovenfit_check_abi(WOVENFIT_ABI_VERSION, &error));
    REFUSED(wovenfit_check_abi(999, &error), WOVENFIT_STATUS_ABI_MISMATCH, "ABI 999");
    REFUSED(wovenfit_check_abi(999, &error), WOVENFIT_STATUS_ABI_MISMATCH, "has ABI 1");
    /* Without a place for the error the status alone. */
    CHECK(wovenfit_check_abi(0, NULL) == WOVENFIT_STATUS_ABI_MISMATCH);
    CHECK(strcmp(wovenfit_status_name(WOVENFIT_STATUS_TIMEOUT), "timeout") == 0);
    CHECK(strcmp(wovenfit_status_name(-3), "unknown") == 0);
    CHECK(strcmp(wovenfit_stage_name(WOVENFIT_JOB_STAGE_FIT), "fit") == 0);
    CHECK(strcmp(wovenfit_stage_name(77), "unknown") == 0);
    CHECK(wovenfit_error_status(NULL) == WOVENFIT_STATUS_OK);
    size_t needed = 5;
    CHECK(wovenfit_error_text(NULL, NULL, 0, &needed) == WOVENFIT_STATUS_NULL_ARGUMENT);
    CHECK(needed == 5);
    double mm = 0.0;
    DONE(wovenfit_unit_millimetres("in", &mm, &error));
    CHECK(mm == 25.4);
    REFUSED(wovenfit_unit_millimetres("ft", &mm, &error), WOVENFIT_STATUS_INVALID_ARGUMENT, "`cm`");
    REFUSED(wovenfit_unit_millimetres(NULL, &mm, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`name`");
    REFUSED(wovenfit_unit_millimetres("mm", NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`mm_per_unit`");
    CHECK(mm == 25.4);
}

void freeing_nothing(void) {
    wovenfit_error_free(NULL);
    wovenfit_mesh_free(NULL);
    wovenfit_design_free(NULL);
    wovenfit_parameters_free(NULL);
    wovenfit_check_free(NULL);
    wovenfit_job_free(NULL);
    wovenfit_prepared_free(NULL);
    wovenfit_result_free(NULL);
}

int main(void) {
    versions();
    freeing_nothing();
    meshes();
    checking();
    parameters();
    wovenfit_mesh *mesh = limb_mesh();
    designs(mesh);
    jobs(mesh);
    on_the_mesh(mesh);
    wovenfit_mesh_free(mesh);
    printf("%d checks\n", checks);
    return 0;
}
