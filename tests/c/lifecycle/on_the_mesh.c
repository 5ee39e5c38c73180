/* Wishes on the mesh itself: a selection of triangles, a seam along edges, painted pressure. */

#include "lifecycle.h"

void on_the_mesh(const wovenfit_mesh *mesh) {
    wovenfit_design *design = NULL;
    wovenfit_job *job = NULL;
    wovenfit_result *result = NULL;
    wovenfit_error *error = NULL;
    wovenfit_result_summary summary;
    double paint[VERTICES] = {0};
    uint32_t selected[TRIANGLES], seam[2 * (RINGS - 1)];
    size_t count = 0, needed = 0;
    char words[4000];
    DONE(wovenfit_design_new(1.0, &design, &error));
    /* All but the last two rings; the seam goes down all rings. */
    uint32_t kept = 2 * SIDES * (RINGS - 3);
    for (uint32_t t = 0; t < kept; t++) selected[t] = kept - 1 - t;
    DONE(wovenfit_design_set_region_triangles(design, mesh, selected, kept, &error));
    for (uint32_t ring = 0; ring + 1 < RINGS; ring++)
        seam[2 * ring] = ring * SIDES, seam[2 * ring + 1] = (ring + 1) * SIDES;
    DONE(wovenfit_design_add_seams_along_edges(design, mesh, seam, RINGS - 3, &error));
    for (int v = 4 * SIDES + 4; v < 6 * SIDES; v++) paint[v] = 1.0;
    DONE(wovenfit_design_paint_pressures(design, mesh, paint, VERTICES, &error));
    DONE(wovenfit_design_pressure_count(design, &count, &error));
    CHECK(count > 1 && count <= SIDES * 2 - 4);
    paint[5] = NAN;
    REFUSED(wovenfit_design_paint_pressures(design, mesh, paint, VERTICES, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "number 5 of `kpa` is NaN");
    DONE(wovenfit_job_start(mesh, design, NULL, &job, &error));
    DONE(wovenfit_job_wait(job, -1.0, &error));
    DONE(wovenfit_job_result(job, &result, &error));
    DONE(wovenfit_result_figures(result, &summary, &error));
    CHECK(summary.pressures == count);
    double *pressure = doubles(result, WOVENFIT_RESULT_ARRAY_GIVEN_PRESSURE_KPA, &needed);
    /* The last ring is not covered, the first is. */
    CHECK(isnan(pressure[VERTICES - 1]) && isfinite(pressure[0]));
    free(pressure);
    double *corners = doubles(result, WOVENFIT_RESULT_ARRAY_GIVEN_PATTERN_PER_CORNER, &needed);
    for (uint32_t t = 0; t < TRIANGLES; t++) CHECK(isnan(corners[6 * t]) == (t >= kept));
    free(corners);
    uint32_t *starts = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_SEAM_STARTS, &needed);
    CHECK(needed == 2);
    free(starts);
    int automatic = 0;
    for (size_t i = 0; i < summary.warnings; i++) {
        DONE(wovenfit_result_warning_text(result, i, WOVENFIT_NOTE_TEXT_CODE, words, sizeof words,
                                          &needed, &error));
        automatic += strcmp(words, "seam_automatic") == 0;
    }
    CHECK(automatic == 0);
    wovenfit_result_free(result);
    wovenfit_job_free(job);
    /* The selection fits no other mesh. */
    wovenfit_mesh *other = NULL;
    const double corner[9] = {0, 0, 0, 100, 0, 0, 0, 100, 0};
    DONE(wovenfit_mesh_new_f64(corner, 3, 0, (const uint32_t[]){0, 1, 2}, 1, 1.0, &other, &error));
    REFUSED(wovenfit_job_start(other, design, NULL, &job, &error), WOVENFIT_STATUS_INVALID_ARGUMENT,
            "308 triangles");
    wovenfit_mesh_free(other);
    wovenfit_design_free(design);
}
