/* Meshes from buffers, and what is wrong with them. */

#include "lifecycle.h"

void meshes(void) {
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

void checking(void) {
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
