/* Walks a host's whole way through the ABI, and every way in which it is refused. */

#include "limb.h"

/* An array of a result; the caller frees it. */
static double *doubles(const wovenfit_result *result, int32_t what, size_t *count) {
    wovenfit_error *error = NULL;
    DONE(wovenfit_result_doubles(result, what, NULL, 0, count, &error));
    double *values = malloc((*count + 1) * sizeof *values);
    CHECK(values != NULL);
    if (*count > 0) {
        size_t needed = 0;
        values[0] = -7.0;
        REFUSED(wovenfit_result_doubles(result, what, values, *count - 1, &needed, &error),
                *count > 1 ? WOVENFIT_STATUS_BUFFER_TOO_SMALL : WOVENFIT_STATUS_BUFFER_TOO_SMALL,
                "the buffer holds");
        CHECK(needed == *count && values[0] == -7.0);
    }
    DONE(wovenfit_result_doubles(result, what, values, *count, count, &error));
    return values;
}

static uint32_t *indices(const wovenfit_result *result, int32_t what, size_t *count) {
    wovenfit_error *error = NULL;
    DONE(wovenfit_result_indices(result, what, NULL, 0, count, &error));
    uint32_t *values = malloc((*count + 1) * sizeof *values);
    CHECK(values != NULL);
    DONE(wovenfit_result_indices(result, what, values, *count, count, &error));
    return values;
}

static char *text(const wovenfit_result *result, int32_t what) {
    wovenfit_error *error = NULL;
    size_t needed = 0;
    DONE(wovenfit_result_text(result, what, NULL, 0, &needed, &error));
    char *words = malloc(needed);
    CHECK(words != NULL);
    REFUSED(wovenfit_result_text(result, what, words, needed - 1, &needed, &error),
            WOVENFIT_STATUS_BUFFER_TOO_SMALL, "the buffer holds");
    DONE(wovenfit_result_text(result, what, words, needed, &needed, &error));
    CHECK(strlen(words) + 1 == needed);
    return words;
}

static void versions(void) {
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

static void freeing_nothing(void) {
    wovenfit_error_free(NULL);
    wovenfit_mesh_free(NULL);
    wovenfit_design_free(NULL);
    wovenfit_parameters_free(NULL);
    wovenfit_check_free(NULL);
    wovenfit_job_free(NULL);
    wovenfit_prepared_free(NULL);
    wovenfit_result_free(NULL);
}

static void meshes(void) {
    double positions[3 * VERTICES];
    uint32_t triangles[3 * TRIANGLES];
    float narrow[4 * VERTICES];
    wovenfit_mesh *mesh = NULL;
    wovenfit_error *error = NULL;
    size_t vertices = 0, faces = 0;
    make_limb(positions, triangles);
    /* 32 bits, four numbers apart, as hosts keep points with something beside them. */
    for (int v = 0; v < VERTICES; v++) {
        for (int k = 0; k < 3; k++) narrow[4 * v + k] = (float)(positions[3 * v + k] / 1000.0);
        narrow[4 * v + 3] = NAN;
    }
    DONE(wovenfit_mesh_new_f32(narrow, VERTICES, 16, triangles, TRIANGLES, 1000.0, &mesh, &error));
    DONE(wovenfit_mesh_size(mesh, &vertices, &faces, &error));
    CHECK(vertices == VERTICES && faces == TRIANGLES);
    REFUSED(wovenfit_mesh_size(mesh, NULL, &faces, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`vertex_count`");
    REFUSED(wovenfit_mesh_size(NULL, &vertices, &faces, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`mesh`");
    wovenfit_mesh_free(mesh);

    wovenfit_mesh *untouched = mesh = NULL;
#define MESH(points, count, stride, corners, number, unit, out) \
    wovenfit_mesh_new_f64(points, count, stride, corners, number, unit, out, &error)
    REFUSED(MESH(NULL, VERTICES, 0, triangles, TRIANGLES, 1.0, &mesh),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`positions`");
    REFUSED(MESH(positions, VERTICES, 0, NULL, TRIANGLES, 1.0, &mesh),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`triangles`");
    REFUSED(MESH(positions, VERTICES, 0, triangles, TRIANGLES, 1.0, NULL),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`mesh`");
    REFUSED(MESH(positions, VERTICES, 8, triangles, TRIANGLES, 1.0, &mesh),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`stride` is 8");
    REFUSED(MESH(positions, VERTICES, SIZE_MAX, triangles, TRIANGLES, 1.0, &mesh),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`stride`");
    REFUSED(MESH(positions, SIZE_MAX, 0, triangles, TRIANGLES, 1.0, &mesh),
            WOVENFIT_STATUS_TOO_LARGE, "6000000");
    REFUSED(MESH(positions, VERTICES, 0, triangles, SIZE_MAX, 1.0, &mesh),
            WOVENFIT_STATUS_TOO_LARGE, "2000000");
    const double scales[] = {0.0, -1.0, NAN, INFINITY, 1e300};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++)
        REFUSED(MESH(positions, VERTICES, 0, triangles, TRIANGLES, scales[i], &mesh),
                WOVENFIT_STATUS_INVALID_ARGUMENT, "`mm_per_unit`");
    CHECK(mesh == untouched);
    /* Nothing is a mesh, with a defect. */
    DONE(MESH(NULL, 0, 0, NULL, 0, 1.0, &mesh));
    wovenfit_mesh_free(mesh);
#undef MESH
}

static void checking(void) {
    double positions[3 * VERTICES];
    uint32_t triangles[3 * TRIANGLES];
    wovenfit_mesh *mesh = limb_mesh();
    wovenfit_check *check = NULL;
    wovenfit_error *error = NULL;
    size_t defects = 9, warnings = 9, needed = 0, count = 0;
    DONE(wovenfit_check_run(mesh, NULL, NULL, &check, &error));
    DONE(wovenfit_check_count(check, &defects, &warnings, &error));
    CHECK(defects == 0);
    DONE(wovenfit_check_json(check, NULL, 0, &needed, &error));
    char *json = malloc(needed);
    CHECK(json != NULL);
    DONE(wovenfit_check_json(check, json, needed, &needed, &error));
    CHECK(strstr(json, "tube: cut along a seam") != NULL && strstr(json, "girth_mm") != NULL);
    free(json);
    double at[3];
    REFUSED(wovenfit_check_defect_place(check, 0, at, &error), WOVENFIT_STATUS_OUT_OF_RANGE,
            "defect 0");
    REFUSED(wovenfit_check_warning_place(check, 99, at, &error), WOVENFIT_STATUS_OUT_OF_RANGE,
            "warning 99");
    REFUSED(wovenfit_check_run(NULL, NULL, NULL, &check, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`mesh`");
    REFUSED(wovenfit_check_run(mesh, NULL, NULL, NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`check`");
    wovenfit_check_free(check);
    wovenfit_mesh_free(mesh);

    /* One place that is none, one corner that names no vertex, one hole with a crumb in it. */
    make_limb(positions, triangles);
    positions[3 * 40 + 1] = NAN;
    triangles[3 * 100] = 4000000000u;
    DONE(wovenfit_mesh_new_f64(positions, VERTICES, 0, triangles, TRIANGLES, 1.0, &mesh, &error));
    DONE(wovenfit_check_run(mesh, NULL, NULL, &check, &error));
    DONE(wovenfit_check_count(check, &defects, &warnings, &error));
    CHECK(defects == 2);
    char words[4000];
    uint32_t elements[8];
    int found = 0;
    for (size_t i = 0; i < defects; i++) {
        DONE(wovenfit_check_defect_text(check, i, WOVENFIT_NOTE_TEXT_MESSAGE, words, sizeof words,
                                        &needed, &error));
        CHECK(strlen(words) > 20);
        DONE(wovenfit_check_defect_text(check, i, WOVENFIT_NOTE_TEXT_CODE, words, sizeof words,
                                        &needed, &error));
        DONE(wovenfit_check_defect_place(check, i, at, &error));
        DONE(wovenfit_check_defect_vertices(check, i, elements, 8, &count, &error));
        CHECK(count == 1);
        if (strcmp(words, "not_finite") == 0) {
            found += 1;
            CHECK(elements[0] == 40 && isnan(at[0]));
        } else if (strcmp(words, "index_out_of_range") == 0) {
            found += 2;
            CHECK(elements[0] == 4000000000u && isfinite(at[0]));
            DONE(wovenfit_check_defect_triangles(check, i, elements, 8, &count, &error));
            CHECK(count == 1 && elements[0] == 100);
        }
    }
    CHECK(found == 3);
    REFUSED(wovenfit_check_defect_text(check, 0, 77, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is 77");
    wovenfit_check_free(check);
    wovenfit_mesh_free(mesh);

    /* In metres it is no limb, and in mm its triangles turned inside out are a warning. */
    make_limb(positions, triangles);
    DONE(wovenfit_mesh_new_f64(positions, VERTICES, 0, triangles, TRIANGLES, 1000.0, &mesh, &error));
    DONE(wovenfit_check_run(mesh, NULL, NULL, &check, &error));
    DONE(wovenfit_check_defect_text(check, 0, WOVENFIT_NOTE_TEXT_CODE, words, sizeof words, &needed,
                                    &error));
    CHECK(strcmp(words, "unit") == 0);
    wovenfit_check_free(check);
    wovenfit_mesh_free(mesh);
    for (int t = 0; t < TRIANGLES; t++) {
        uint32_t corner = triangles[3 * t];
        triangles[3 * t] = triangles[3 * t + 1];
        triangles[3 * t + 1] = corner;
    }
    DONE(wovenfit_mesh_new_f64(positions, VERTICES, 0, triangles, TRIANGLES, 1.0, &mesh, &error));
    DONE(wovenfit_check_run(mesh, NULL, NULL, &check, &error));
    DONE(wovenfit_check_count(check, &defects, &warnings, &error));
    CHECK(defects == 0 && warnings > 0);
    DONE(wovenfit_check_warning_text(check, 0, WOVENFIT_NOTE_TEXT_CODE, words, sizeof words, &needed,
                                     &error));
    CHECK(strcmp(words, "reversed") == 0);
    DONE(wovenfit_check_warning_place(check, 0, at, &error));
    CHECK(isnan(at[2]));
    wovenfit_check_free(check);
    wovenfit_mesh_free(mesh);
}

static void parameters(void) {
    wovenfit_parameters *values = NULL, *copy = NULL;
    wovenfit_error *error = NULL;
    size_t needed = 0;
    char words[4000];
    int choices = 0;
    CHECK(wovenfit_parameter_count() > 10);
    DONE(wovenfit_parameters_new(&values, &error));
    for (size_t i = 0; i < wovenfit_parameter_count(); i++) {
        char name[64];
        wovenfit_parameter_bounds bounds;
        DONE(wovenfit_parameter_describe(i, WOVENFIT_PARAMETER_TEXT_NAME, name, sizeof name, &needed,
                                         &error));
        for (int32_t what = WOVENFIT_PARAMETER_TEXT_UNIT; what <= WOVENFIT_PARAMETER_TEXT_PARAGRAPH;
             what++)
            DONE(wovenfit_parameter_describe(i, what, words, sizeof words, &needed, &error));
        DONE(wovenfit_parameter_range(i, &bounds, &error));
        int ranged = bounds.kind == WOVENFIT_PARAMETER_KIND_NUMBER ||
                     bounds.kind == WOVENFIT_PARAMETER_KIND_INTEGER;
        CHECK(ranged ? bounds.least < bounds.most : isnan(bounds.least));
        CHECK((bounds.kind == WOVENFIT_PARAMETER_KIND_CHOICE) == (bounds.choices > 0));
        for (size_t choice = 0; choice < bounds.choices; choice++, choices++) {
            DONE(wovenfit_parameter_choice(i, choice, words, sizeof words, &needed, &error));
            DONE(wovenfit_parameters_set(values, name, words, &error));
        }
        REFUSED(wovenfit_parameter_choice(i, bounds.choices, words, sizeof words, &needed, &error),
                WOVENFIT_STATUS_OUT_OF_RANGE, name);
        /* Each can be set to its default and read back. */
        char fallback[64];
        DONE(wovenfit_parameter_describe(i, WOVENFIT_PARAMETER_TEXT_DEFAULT, fallback,
                                         sizeof fallback, &needed, &error));
        DONE(wovenfit_parameters_set(values, name, fallback, &error));
        DONE(wovenfit_parameters_get(values, name, words, sizeof words, &needed, &error));
        CHECK(strcmp(words, fallback) == 0);
    }
    CHECK(choices > 4);
    DONE(wovenfit_parameters_set(values, "spacing", "7.5", &error));
    DONE(wovenfit_parameters_copy(values, &copy, &error));
    DONE(wovenfit_parameters_set(values, "spacing", "8", &error));
    DONE(wovenfit_parameters_get(copy, "spacing", words, sizeof words, &needed, &error));
    CHECK(strcmp(words, "7.5") == 0);
    REFUSED(wovenfit_parameters_set(values, "spaceing", "8", &error), WOVENFIT_STATUS_PARAMETER,
            "nearest name is `spacing`");
    REFUSED(wovenfit_parameters_set(values, "spacing", "1e-9", &error), WOVENFIT_STATUS_PARAMETER,
            "from 0.5 to 30");
    REFUSED(wovenfit_parameters_set(values, "spacing", NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`value`");
    REFUSED(wovenfit_parameters_set(values, "spacing", "\xff", &error), WOVENFIT_STATUS_NOT_UTF8,
            "byte 0");
    REFUSED(wovenfit_parameters_set(NULL, "spacing", "8", &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`parameters`");
    REFUSED(wovenfit_parameters_get(values, "", words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_PARAMETER, "there is no parameter");
    REFUSED(wovenfit_parameters_new(NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`parameters`");
    REFUSED(wovenfit_parameters_copy(values, NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`copy`");
    REFUSED(wovenfit_parameter_describe(9999, 1, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "parameter 9999");
    REFUSED(wovenfit_parameter_describe(0, 0, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is 0");
    REFUSED(wovenfit_parameter_range(0, NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT, "`range`");
    wovenfit_parameters_free(values);
    wovenfit_parameters_free(copy);
}

static void designs(const wovenfit_mesh *mesh) {
    wovenfit_design *design = NULL, *copy = NULL;
    wovenfit_error *error = NULL;
    size_t needed = 0, count = 0;
    char words[20000];
    DONE(wovenfit_design_schema(NULL, 0, &needed, &error));
    CHECK(needed > 1000);
    DONE(wovenfit_design_new(10.0, &design, &error));
    DONE(wovenfit_design_set_number(design, "fabric.warp", 0.75, &error));
    DONE(wovenfit_design_set_text(design, "fabric.name", "power weave", &error));
    DONE(wovenfit_design_set_text(design, "facing", "outward", &error));
    DONE(wovenfit_design_set_text(design, "piece.name", "links \xc3\xa4", &error));
    const double places[] = {4.5, 0.0, 5.0, -4.5, 0.0, 5.0}; /* cm */
    const double kpa[] = {1.5, 0.0};
    DONE(wovenfit_design_add_pressures(design, places, kpa, 2, &error));
    DONE(wovenfit_design_set_orientation(design, (const double[]){4.5, 0, 10, 4, 0, 1}, &error));
    DONE(wovenfit_design_set_orientation_at_vertices(design, mesh, 0, SIDES * 9, &error));
    DONE(wovenfit_design_add_seam(design, (const double[]){0, 4, 11, 0, 3.5, 0}, 2, &error));
    DONE(wovenfit_design_add_region_plane(design, (const double[]){0, 0, 1},
                                          (const double[]){0, 0, 2}, &error));
    DONE(wovenfit_design_add_bony(design, places, 1, &error));
    DONE(wovenfit_design_copy(design, &copy, &error));
    DONE(wovenfit_design_json(design, words, sizeof words, &needed, &error));
    CHECK(strstr(words, "[45.0, 0.0, 50.0]") != NULL && strstr(words, "\"warp\": 0.75") != NULL);
    DONE(wovenfit_design_pressure_count(design, &count, &error));
    CHECK(count == 2);
    const char *clear[] = {"pressures", "orientation", "seams", "region", "limits.bony", "facing",
                           "fabric", "piece", "region_faces"};
    for (size_t i = 0; i < sizeof clear / sizeof *clear; i++)
        DONE(wovenfit_design_clear(design, clear[i], &error));
    DONE(wovenfit_design_json(design, words, sizeof words, &needed, &error));
    CHECK(strstr(words, "45.0") == NULL && strstr(words, "\"warp\": 0.5") != NULL);
    DONE(wovenfit_design_pressure_count(copy, &count, &error));
    CHECK(count == 2);
    wovenfit_design_free(copy);

    REFUSED(wovenfit_design_clear(design, "region.x", &error), WOVENFIT_STATUS_DESIGN, "region.x");
    REFUSED(wovenfit_design_set_number(design, "fabric.wrap", 1, &error), WOVENFIT_STATUS_DESIGN,
            "nearest known key is `warp`");
    REFUSED(wovenfit_design_set_number(design, "fabric.warp", -1, &error), WOVENFIT_STATUS_DESIGN,
            "`fabric.warp` is -1");
    REFUSED(wovenfit_design_set_number(design, "fabric.warp", NAN, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "NaN");
    REFUSED(wovenfit_design_set_text(design, "facing", "up", &error), WOVENFIT_STATUS_DESIGN,
            "\"inward\"");
    REFUSED(wovenfit_design_add_pressures(design, places, (const double[]){99}, 1, &error),
            WOVENFIT_STATUS_DESIGN, "`pressures[0].kpa`");
    REFUSED(wovenfit_design_add_pressures(design, places, (const double[]){-1}, 1, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "number 0 of `kpa`");
    REFUSED(wovenfit_design_add_pressures(design, (const double[]){0, NAN, 0}, kpa, 1, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "point 0 of `positions`");
    REFUSED(wovenfit_design_add_pressures(design, NULL, kpa, 1, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`positions`");
    REFUSED(wovenfit_design_add_pressures(design, places, NULL, 1, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`kpa`");
    REFUSED(wovenfit_design_add_pressures(design, places, kpa, SIZE_MAX, &error),
            WOVENFIT_STATUS_TOO_LARGE, "1000");
    uint32_t beyond = VERTICES;
    REFUSED(wovenfit_design_add_pressures_at_vertices(design, mesh, &beyond, kpa, 1, &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "vertex 168");
    REFUSED(wovenfit_design_paint_pressures(design, mesh, kpa, 2, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "168 vertices");
    REFUSED(wovenfit_design_set_orientation(design, (const double[]){1, 1, 1, 1, 1, 1}, &error),
            WOVENFIT_STATUS_DESIGN, "`orientation`");
    REFUSED(wovenfit_design_set_orientation_at_vertices(design, mesh, 0, beyond, &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "vertex 168");
    REFUSED(wovenfit_design_add_seam(design, places, 1, &error), WOVENFIT_STATUS_DESIGN, "seams[0]");
    REFUSED(wovenfit_design_add_seams_along_edges(design, mesh, (const uint32_t[]){0, beyond}, 1,
                                                  &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "vertex 168");
    REFUSED(wovenfit_design_add_seams_along_edges(design, mesh, NULL, SIZE_MAX, &error),
            WOVENFIT_STATUS_TOO_LARGE, "edges");
    REFUSED(wovenfit_design_add_region_plane(design, places, (const double[]){0, 0, 0}, &error),
            WOVENFIT_STATUS_DESIGN, "region[0].normal");
    uint32_t far = TRIANGLES;
    REFUSED(wovenfit_design_set_region_triangles(design, mesh, &far, 1, &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "triangle 308");
    REFUSED(wovenfit_design_set_region_triangles(design, mesh, NULL, 0, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "no triangle");
    REFUSED(wovenfit_design_new(0, &design, &error), WOVENFIT_STATUS_INVALID_ARGUMENT,
            "`mm_per_unit`");
    wovenfit_design_free(design);

    design = NULL;
    REFUSED(wovenfit_design_from_json("{", 1.0, &design, &error), WOVENFIT_STATUS_DESIGN, "line 1");
    REFUSED(wovenfit_design_from_json("{\"presures\": []}", 1.0, &design, &error),
            WOVENFIT_STATUS_DESIGN, "nearest known key is `pressures`");
    REFUSED(wovenfit_design_from_json("{\"pressures\": []}", 7.0, &design, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`units`");
    REFUSED(wovenfit_design_from_json(NULL, 1.0, &design, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`json`");
    REFUSED(wovenfit_design_from_json("\xc3(", 1.0, &design, &error), WOVENFIT_STATUS_NOT_UTF8,
            "`json`");
    CHECK(design == NULL);
    DONE(wovenfit_design_from_json("{\"pressures\": [{\"at\": [1, 2, 3], \"mmhg\": 20}]}", 1000.0,
                                   &design, &error));
    DONE(wovenfit_design_json(design, words, sizeof words, &needed, &error));
    CHECK(strstr(words, "[1000.0, 2000.0, 3000.0]") != NULL);
    wovenfit_design_free(design);
}

static void results(const wovenfit_result *result) {
    wovenfit_error *error = NULL;
    wovenfit_result_summary summary;
    wovenfit_pressure pressure;
    size_t n = 0, count = 0, triangles = 0, needed = 0;
    char words[4000];
    DONE(wovenfit_result_figures(result, &summary, &error));
    CHECK(summary.converged == 1 && summary.flipped == 0 && summary.overlaps == 0);
    CHECK(summary.pressures == 1 && summary.width_mm > 100 && summary.height_mm > 90);
    DONE(wovenfit_result_pressure(result, 0, &pressure, &error));
    CHECK(pressure.asked_kpa > 0 && pressure.met == 1);
    CHECK(fabs(pressure.got_kpa / pressure.asked_kpa - 1) < 0.01);
    DONE(wovenfit_result_pressure_reason(result, 0, WOVENFIT_NOTE_TEXT_CODE, words, sizeof words,
                                         &needed, &error));
    CHECK(needed == 1 && words[0] == 0);
    REFUSED(wovenfit_result_pressure(result, 1, &pressure, &error), WOVENFIT_STATUS_OUT_OF_RANGE,
            "pressure 1");
    CHECK(summary.warnings > 0);
    double at[3];
    for (size_t i = 0; i < summary.warnings; i++) {
        DONE(wovenfit_result_warning_text(result, i, WOVENFIT_NOTE_TEXT_MESSAGE, words, sizeof words,
                                          &needed, &error));
        DONE(wovenfit_result_warning_place(result, i, at, &error));
    }
    REFUSED(wovenfit_result_warning_text(result, summary.warnings, 1, words, sizeof words, &needed,
                                         &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "warning");

    /* The cut surface: every array has the size that the header states. */
    free(doubles(result, WOVENFIT_RESULT_ARRAY_PATTERN, &count));
    size_t vertices = count / 2;
    free(indices(result, WOVENFIT_RESULT_INDEX_ARRAY_TRIANGLES, &count));
    triangles = count / 3;
    CHECK(vertices > VERTICES && triangles >= TRIANGLES);
    const struct { int32_t what; size_t size; } arrays[] = {
        {WOVENFIT_RESULT_ARRAY_PATTERN_PER_CORNER, 6 * triangles},
        {WOVENFIT_RESULT_ARRAY_POSITIONS, 3 * vertices},
        {WOVENFIT_RESULT_ARRAY_VERTEX_WEIGHTS, 3 * vertices},
        {WOVENFIT_RESULT_ARRAY_WARP_STRAIN, vertices},
        {WOVENFIT_RESULT_ARRAY_WEFT_STRAIN, vertices},
        {WOVENFIT_RESULT_ARRAY_AREA_STRETCH, vertices},
        {WOVENFIT_RESULT_ARRAY_PRESSURE_KPA, vertices},
        {WOVENFIT_RESULT_ARRAY_FRICTION, vertices},
        {WOVENFIT_RESULT_ARRAY_SEAM_LENGTHS, 2},
        {WOVENFIT_RESULT_ARRAY_GIVEN_PATTERN_PER_CORNER, 6 * TRIANGLES},
        {WOVENFIT_RESULT_ARRAY_GIVEN_WARP_STRAIN, VERTICES},
        {WOVENFIT_RESULT_ARRAY_GIVEN_WEFT_STRAIN, VERTICES},
        {WOVENFIT_RESULT_ARRAY_GIVEN_PRESSURE_KPA, VERTICES},
    };
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        double *values = doubles(result, arrays[i].what, &n);
        CHECK(n == arrays[i].size);
        /* All of this limb is covered. */
        for (size_t k = 0; k < n && arrays[i].what != WOVENFIT_RESULT_ARRAY_FRICTION; k++)
            CHECK(isfinite(values[k]));
        free(values);
    }
    free(doubles(result, WOVENFIT_RESULT_ARRAY_GIRTHS, &n));
    CHECK(n >= 2 && n % 2 == 0);
    const struct { int32_t what; size_t size, below; } lists[] = {
        {WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_VERTEX, vertices, VERTICES},
        {WOVENFIT_RESULT_INDEX_ARRAY_VERTEX_TO_GIVEN_TRIANGLE, vertices, TRIANGLES},
        {WOVENFIT_RESULT_INDEX_ARRAY_TRIANGLE_TO_GIVEN_TRIANGLE, triangles, TRIANGLES},
    };
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        uint32_t *values = indices(result, lists[i].what, &n);
        CHECK(n == lists[i].size);
        for (size_t k = 0; k < n; k++)
            CHECK(values[k] < lists[i].below || (values[k] == WOVENFIT_NONE && i == 0));
        free(values);
    }
    /* Outline and seams: what is stored twice agrees. */
    double *outline = doubles(result, WOVENFIT_RESULT_ARRAY_OUTLINE, &n);
    double *pattern = doubles(result, WOVENFIT_RESULT_ARRAY_PATTERN, &count);
    uint32_t *around = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_OUTLINE, &count);
    CHECK(n == 2 * count);
    for (size_t k = 0; k < count; k++)
        CHECK(outline[2 * k] == pattern[2 * around[k]] && outline[2 * k + 1] == pattern[2 * around[k] + 1]);
    free(outline), free(around);
    uint32_t *starts = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_OUTLINE_STARTS, &n);
    CHECK(n == 2 && starts[0] == 0 && starts[1] == count);
    free(starts);
    uint32_t *left = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_SEAM_LEFT, &n);
    uint32_t *right = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_SEAM_RIGHT, &count);
    starts = indices(result, WOVENFIT_RESULT_INDEX_ARRAY_SEAM_STARTS, &needed);
    CHECK(n == count && needed == 2 && starts[1] == n);
    double *positions = doubles(result, WOVENFIT_RESULT_ARRAY_POSITIONS, &needed);
    for (size_t k = 0; k < n; k++)
        CHECK(memcmp(positions + 3 * left[k], positions + 3 * right[k], 3 * sizeof(double)) == 0);
    free(left), free(right), free(starts), free(positions), free(pattern);

    const struct { int32_t what; const char *words; } texts[] = {
        {WOVENFIT_RESULT_FILE_REPORT_JSON, "\"pressures\""},
        {WOVENFIT_RESULT_FILE_REPORT_HTML, "<!DOCTYPE html"},
        {WOVENFIT_RESULT_FILE_PATTERN_SVG, "<svg"},
        {WOVENFIT_RESULT_FILE_WORN_OBJ, "vt "},
        {WOVENFIT_RESULT_FILE_FLAT_OBJ, "f "},
        {WOVENFIT_RESULT_FILE_TABLE, "mmHg"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char *words = text(result, texts[i].what);
        CHECK(strstr(words, texts[i].words) != NULL);
        free(words);
    }
    REFUSED(wovenfit_result_text(result, 0, NULL, 0, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is 0");
    REFUSED(wovenfit_result_doubles(result, -1, NULL, 0, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is -1");
    REFUSED(wovenfit_result_indices(result, 1000, NULL, 0, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is 1000");
    REFUSED(wovenfit_result_doubles(result, 1, NULL, 4, &needed, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`buffer`");
    REFUSED(wovenfit_result_doubles(NULL, 1, NULL, 0, &needed, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`result`");
    REFUSED(wovenfit_result_figures(result, NULL, &error), WOVENFIT_STATUS_NULL_ARGUMENT,
            "`figures`");
}

static void jobs(const wovenfit_mesh *mesh) {
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

/* Wishes on the mesh itself: a selection of triangles, a seam along edges, painted pressure. */
static void on_the_mesh(const wovenfit_mesh *mesh) {
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
