/* The table of parameters, and designs. */

#include "lifecycle.h"

void parameters(void) {
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

void designs(const wovenfit_mesh *mesh) {
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
