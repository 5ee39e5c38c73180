/* All that a result gives. */

#include "lifecycle.h"

/* An array of a result; the caller frees it. */
double *doubles(const wovenfit_result *result, int32_t what, size_t *count) {
    wovenfit_error *error = NULL;
    DONE(wovenfit_result_doubles(result, what, NULL, 0, count, &error));
    double *values = malloc((*count + 1) * sizeof *values);
    CHECK(values != NULL);
    if (*count > 0) {
        size_t needed = 0;
        values[0] = -7.0;
        REFUSED(wovenfit_result_doubles(result, what, values, *count - 1, &needed, &error),
                WOVENFIT_STATUS_BUFFER_TOO_SMALL, "the buffer holds");
        CHECK(needed == *count && values[0] == -7.0);
    }
    DONE(wovenfit_result_doubles(result, what, values, *count, count, &error));
    return values;
}

uint32_t *indices(const wovenfit_result *result, int32_t what, size_t *count) {
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

/* The pattern in every format, in both units. */
static void formats(const wovenfit_result *result) {
    wovenfit_error *error = NULL;
    char name[100], words[400];
    size_t needed = 0, count = 0;
    CHECK(wovenfit_format_count() >= 9);
    for (size_t i = 0; i < wovenfit_format_count(); i++) {
        DONE(wovenfit_format_describe(i, WOVENFIT_FORMAT_TEXT_NAME, name, sizeof name, &needed, &error));
        CHECK(strlen(name) + 1 == needed);
        DONE(wovenfit_format_describe(i, WOVENFIT_FORMAT_TEXT_FILE_NAME, words, sizeof words, &needed,
                                      &error));
        CHECK(strncmp(words, "pattern", 7) == 0 && strchr(words, '.') != NULL);
        DONE(wovenfit_format_describe(i, WOVENFIT_FORMAT_TEXT_SUMMARY, words, sizeof words, &needed,
                                      &error));
        CHECK(needed > 20);
        for (int k = 0; k < 2; k++) {
            const char *unit = k ? "in" : "mm";
            DONE(wovenfit_result_pattern(result, name, unit, NULL, 0, &needed, &error));
            CHECK(needed > 500);
            uint8_t *bytes = malloc(needed);
            CHECK(bytes != NULL);
            REFUSED(wovenfit_result_pattern(result, name, unit, bytes, needed - 1, &count, &error),
                    WOVENFIT_STATUS_BUFFER_TOO_SMALL, "the buffer holds");
            CHECK(count == needed);
            DONE(wovenfit_result_pattern(result, name, unit, bytes, needed, &count, &error));
            CHECK(count == needed);
            /* All but the PNG are text; that of a PDF and a PNG begins with its name. */
            if (strncmp(name, "pdf", 3) == 0) CHECK(memcmp(bytes, "%PDF-", 5) == 0);
            if (strcmp(name, "png") == 0) CHECK(memcmp(bytes, "\x89PNG", 4) == 0);
            if (strncmp(name, "dxf", 3) == 0) CHECK(memcmp(bytes, "  0\nSECTION", 11) == 0);
            free(bytes);
            DONE(wovenfit_result_pattern_notes(result, name, unit, words, sizeof words, &needed, &error));
        }
    }
    REFUSED(wovenfit_format_describe(9999, 1, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_OUT_OF_RANGE, "format 9999");
    REFUSED(wovenfit_format_describe(0, 0, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "`what` is 0");
    REFUSED(wovenfit_result_pattern(result, "docx", "mm", NULL, 0, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "dxf-astm");
    REFUSED(wovenfit_result_pattern(result, "dxf", "cm", NULL, 0, &needed, &error),
            WOVENFIT_STATUS_INVALID_ARGUMENT, "\"mm\" or \"in\"");
    REFUSED(wovenfit_result_pattern(NULL, "dxf", "mm", NULL, 0, &needed, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`result`");
    REFUSED(wovenfit_result_pattern(result, NULL, "mm", NULL, 0, &needed, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`format`");
    REFUSED(wovenfit_result_pattern_notes(result, "dxf", NULL, words, sizeof words, &needed, &error),
            WOVENFIT_STATUS_NULL_ARGUMENT, "`unit`");
}

void results(const wovenfit_result *result) {
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
        {WOVENFIT_RESULT_ARRAY_PRESSURE_POINTS, 2 * summary.pressures},
        {WOVENFIT_RESULT_ARRAY_ORIENTATION_MARKERS, 4},
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
    formats(result);
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
