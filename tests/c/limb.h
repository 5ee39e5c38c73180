/* A small limb, wishes for it, and what the programs of this folder check with. */

#ifndef LIMB_H
#define LIMB_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "wovenfit.h"

/* How many things were checked; each program defines it. */
extern int checks;

/* Ends the program if a condition does not hold: what follows would build on it. */
#define CHECK(condition)                                                             \
    do {                                                                             \
        checks++;                                                                    \
        if (!(condition)) {                                                          \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition);  \
            exit(1);                                                                 \
        }                                                                            \
    } while (0)

/* The text of an error; the caller frees it. */
static inline char *text_of(const wovenfit_error *error) {
    size_t needed = 0;
    CHECK(wovenfit_error_text(error, NULL, 0, &needed) == WOVENFIT_STATUS_OK);
    char *text = malloc(needed);
    CHECK(text != NULL);
    CHECK(wovenfit_error_text(error, text, needed, &needed) == WOVENFIT_STATUS_OK);
    CHECK(strlen(text) + 1 == needed);
    return text;
}

/* A call that must succeed; `error` is the variable that it writes. */
#define DONE(call)                                                                   \
    do {                                                                             \
        wovenfit_status status_ = (call);                                            \
        checks++;                                                                    \
        if (status_ != WOVENFIT_STATUS_OK) {                                         \
            char *text_ = text_of(error);                                            \
            fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, __LINE__,                   \
                    wovenfit_status_name(status_), text_);                           \
            free(text_);                                                             \
            exit(1);                                                                 \
        }                                                                            \
        CHECK(error == NULL);                                                        \
    } while (0)

/* A call that must be refused with a status and a text that contains `words`. */
#define REFUSED(call, wanted, words)                                                 \
    do {                                                                             \
        wovenfit_status status_ = (call);                                            \
        CHECK(status_ == (wanted));                                                  \
        CHECK(error != NULL);                                                        \
        CHECK(wovenfit_error_status(error) == (wanted));                             \
        char *text_ = text_of(error);                                                \
        checks++;                                                                    \
        if (strstr(text_, (words)) == NULL) {                                        \
            fprintf(stderr, "%s:%d: `%s` is not in: %s\n", __FILE__, __LINE__,       \
                    (words), text_);                                                 \
            exit(1);                                                                 \
        }                                                                            \
        free(text_);                                                                 \
        wovenfit_error_free(error);                                                  \
        error = NULL;                                                                \
    } while (0)

/* A cone of oval girth, open at both ends: 14 sides, 12 rings, 308 triangles, 110 mm long. */
enum { SIDES = 14, RINGS = 12, VERTICES = SIDES * RINGS, TRIANGLES = 2 * SIDES * (RINGS - 1) };

static inline void make_limb(double *positions, uint32_t *triangles) {
    const double pi = 3.14159265358979323846;
    for (int ring = 0; ring < RINGS; ring++) {
        for (int side = 0; side < SIDES; side++) {
            double angle = 2.0 * pi * (side + 0.5 * (ring % 2)) / SIDES;
            double radius = 45.0 - 0.8 * ring;
            double *p = positions + 3 * (ring * SIDES + side);
            p[0] = radius * cos(angle);
            p[1] = 0.9 * radius * sin(angle);
            p[2] = 110.0 - 10.0 * ring;
        }
    }
    for (uint32_t ring = 0; ring + 1 < RINGS; ring++) {
        for (uint32_t side = 0; side < SIDES; side++) {
            uint32_t a = ring * SIDES + side, b = ring * SIDES + (side + 1) % SIDES;
            uint32_t shift = ring % 2; /* The next ring is turned by half a side. */
            uint32_t c = (ring + 1) * SIDES + (side + shift) % SIDES;
            uint32_t before = (ring + 1) * SIDES + (side + shift + SIDES - 1) % SIDES;
            uint32_t *t = triangles + 6 * (ring * SIDES + side);
            /* Seen from outside counter-clockwise; rings go down. */
            t[0] = a, t[1] = before, t[2] = c;
            t[3] = a, t[4] = c, t[5] = b;
        }
    }
}

/* The limb as a mesh. */
static inline wovenfit_mesh *limb_mesh(void) {
    double positions[3 * VERTICES];
    uint32_t triangles[3 * TRIANGLES];
    wovenfit_mesh *mesh = NULL;
    wovenfit_error *error = NULL;
    make_limb(positions, triangles);
    DONE(wovenfit_mesh_new_f64(positions, VERTICES, 0, triangles, TRIANGLES, 1.0, &mesh, &error));
    return mesh;
}

/* A design with one pressure half way along the limb. */
static inline wovenfit_design *limb_design(const wovenfit_mesh *mesh, double kpa) {
    wovenfit_design *design = NULL;
    wovenfit_error *error = NULL;
    uint32_t vertex = (RINGS / 2) * SIDES + 3;
    DONE(wovenfit_design_new(1.0, &design, &error));
    DONE(wovenfit_design_add_pressures_at_vertices(design, mesh, &vertex, &kpa, 1, &error));
    return design;
}

#endif
