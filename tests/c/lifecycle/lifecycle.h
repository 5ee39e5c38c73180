/* The parts of the walk, and what they share. */

#ifndef LIFECYCLE_H
#define LIFECYCLE_H

#include "limb.h"

/* main.c */
void versions(void);
void freeing_nothing(void);

/* surfaces.c */
void meshes(void);
void checking(void);

/* wishes.c */
void parameters(void);
void designs(const wovenfit_mesh *mesh);

/* results.c */
double *doubles(const wovenfit_result *result, int32_t what, size_t *count);
uint32_t *indices(const wovenfit_result *result, int32_t what, size_t *count);
void results(const wovenfit_result *result);

/* jobs.c */
void jobs(const wovenfit_mesh *mesh);

/* on_the_mesh.c */
void on_the_mesh(const wovenfit_mesh *mesh);

#endif
