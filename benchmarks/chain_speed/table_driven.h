/* The recursion of S2 for any chain, in link axes, from a table of its frames: links, then C and R frames of the cuts. */
#ifndef TABLE_DRIVEN_H
#define TABLE_DRIVEN_H

enum { MOST_FRAMES = 64, MOST_LINKS = 40, MOST_CUTS = 8 };

typedef struct {
    int parent;        /* -1: the base */
    int type;          /* 0 revolute, 1 prismatic, 2 fixed */
    double turn[9];    /* Rz(psi) Rx(alpha), with Rz(theta) where theta is constant; by rows */
    double arm[3];     /* constant part of the offset, parent's axes */
    double m;          /* mass */
    double s[3];       /* mass moment from the origin */
    double inertia[9]; /* about the origin, by rows */
} frame;

typedef struct {
    int links;
    int cuts;
    double gravity[3];
    frame frames[MOST_FRAMES];
} chain;

/* phi [6 cuts], J [6 cuts x links] by rows, gamma [6 cuts], M [links x links], f_C and f_G [links]. */
void table_driven(const chain *table, const double *q, const double *qd, double *phi, double *J, double *gamma, double *M,
    double *f_C, double *f_G);

#endif
