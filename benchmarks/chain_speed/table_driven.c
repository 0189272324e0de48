/*
 * Velocities, bias accelerations and Jacobian columns go outwards by S, composite inertias and wrenches come back by its
 * transpose; M is made of composite bodies (no product D^T M D), Jacobians are carried to the cuts only.
 */
#include "table_driven.h"

#include <math.h>
#include <string.h>

static void cross(const double *a, const double *b, double *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* y = R x, R by rows */
static void turned(const double *R, const double *x, double *y)
{
    for (int i = 0; i < 3; ++i) {
        y[i] = R[3 * i] * x[0] + R[3 * i + 1] * x[1] + R[3 * i + 2] * x[2];
    }
}

/* y = R^T x */
static void turned_back(const double *R, const double *x, double *y)
{
    for (int i = 0; i < 3; ++i) {
        y[i] = R[i] * x[0] + R[3 + i] * x[1] + R[6 + i] * x[2];
    }
}

static void product(const double *A, const double *B, double *C)
{
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            C[3 * i + k] = A[3 * i] * B[k] + A[3 * i + 1] * B[3 + k] + A[3 * i + 2] * B[6 + k];
        }
    }
}

typedef struct {
    double R[9], p[3];         /* relative to the parent */
    double R0[9], p0[3];       /* relative to the base */
    double w[3], e[3], a[3];   /* own axes; e and a without joint accelerations */
} motion;

static void moved(const frame *f, double q, double qd, const motion *carrier, motion *own)
{
    const double turning = f->type == 0 ? qd : 0.0, sliding = f->type == 1 ? qd : 0.0;
    memcpy(own->p, f->arm, sizeof own->p);
    if (f->type == 0) {
        const double c = cos(q), s = sin(q);
        for (int i = 0; i < 3; ++i) {
            const double x = f->turn[3 * i], y = f->turn[3 * i + 1];
            own->R[3 * i] = x * c + y * s;
            own->R[3 * i + 1] = y * c - x * s;
            own->R[3 * i + 2] = f->turn[3 * i + 2];
        }
    } else {
        memcpy(own->R, f->turn, sizeof own->R);
    }
    if (f->type == 1) {
        for (int i = 0; i < 3; ++i) {
            own->p[i] += q * f->turn[3 * i + 2];
        }
    }
    double rate[3], twice[3], along[3], before[3];
    product(carrier->R0, own->R, own->R0);
    turned(carrier->R0, own->p, own->p0);
    cross(carrier->w, own->p, rate);
    cross(carrier->w, rate, twice);
    cross(carrier->e, own->p, along);
    for (int i = 0; i < 3; ++i) {
        own->p0[i] += carrier->p0[i];
        along[i] += carrier->a[i] + twice[i];
    }
    turned_back(own->R, along, own->a);
    turned_back(own->R, carrier->w, before);
    turned_back(own->R, carrier->e, own->e);
    own->e[0] += before[1] * turning;
    own->e[1] -= before[0] * turning;
    own->a[0] += 2.0 * before[1] * sliding;
    own->a[1] -= 2.0 * before[0] * sliding;
    memcpy(own->w, before, sizeof before);
    own->w[2] += turning;
}

/* D of a frame: column j for each link that carries it, linear and angular, own axes. */
static void jacobian(const chain *table, const motion *moving, int number, double sign, double *J)
{
    const int n = table->links;
    double R[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, p[3] = {0, 0, 0};
    for (int k = number; k >= 0; k = table->frames[k].parent) {
        const motion *own = &moving[k];
        if (k < n) {
            const double z[3] = {0, 0, 1};
            double linear[3], angular[3], lever[3];
            turned_back(R, z, angular);
            if (table->frames[k].type == 1) {
                for (int i = 0; i < 3; ++i) {
                    J[i * n + k] += sign * angular[i];
                }
            } else {
                cross(z, p, lever);
                turned_back(R, lever, linear);
                for (int i = 0; i < 3; ++i) {
                    J[i * n + k] += sign * linear[i];
                    J[(3 + i) * n + k] += sign * angular[i];
                }
            }
        }
        double moved_p[3], moved_R[9];
        turned(own->R, p, moved_p);
        product(own->R, R, moved_R);
        for (int i = 0; i < 3; ++i) {
            p[i] = own->p[i] + moved_p[i];
        }
        memcpy(R, moved_R, sizeof R);
    }
}

static void closed(const chain *table, const motion *moving, int cut, double *phi, double *J, double *gamma)
{
    const int n = table->links, c = n + cut, r = n + table->cuts + cut;
    const motion *C = &moving[c], *R = &moving[r];
    double T[9], gap[3];
    for (int i = 0; i < 3; ++i) {
        gap[i] = R->p0[i] - C->p0[i];
        for (int k = 0; k < 3; ++k) {
            T[3 * i + k] = C->R0[i] * R->R0[k] + C->R0[3 + i] * R->R0[3 + k] + C->R0[6 + i] * R->R0[6 + k];
        }
        gamma[i] = R->a[i] - C->a[i];
        gamma[3 + i] = R->e[i] - C->e[i];
    }
    turned_back(C->R0, gap, phi);
    const double root = sqrt(1.0 + T[0] + T[4] + T[8]);
    phi[3] = (T[7] - T[5]) / root;
    phi[4] = (T[2] - T[6]) / root;
    phi[5] = (T[3] - T[1]) / root;
    memset(J, 0, sizeof(double) * 6 * (size_t)n);
    jacobian(table, moving, r, 1.0, J);
    jacobian(table, moving, c, -1.0, J);
}

typedef struct {
    double m, s[3], I[9];        /* composite inertia */
    double force[3], moment[3];  /* of the bias motion */
} body;

static void own_body(const frame *f, const motion *own, body *b)
{
    double rate[3], twice[3], turning[3], momentum[3], gyration[3], lever[3], inertial[3];
    b->m = f->m;
    memcpy(b->s, f->s, sizeof b->s);
    memcpy(b->I, f->inertia, sizeof b->I);
    cross(own->w, f->s, rate);
    cross(own->w, rate, twice);
    cross(own->e, f->s, turning);
    turned(f->inertia, own->w, momentum);
    cross(own->w, momentum, gyration);
    turned(f->inertia, own->e, inertial);
    cross(f->s, own->a, lever);
    for (int i = 0; i < 3; ++i) {
        b->force[i] = f->m * own->a[i] + turning[i] + twice[i];
        b->moment[i] = inertial[i] + gyration[i] + lever[i];
    }
}

static void added(const motion *own, const body *child, body *carrier)
{
    double s[3], force[3], moment[3], lever[3], I[9], half[9], total[3];
    turned(own->R, child->s, s);
    turned(own->R, child->force, force);
    turned(own->R, child->moment, moment);
    cross(own->p, force, lever);
    product(own->R, child->I, half);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            I[3 * i + k] =
                half[3 * i] * own->R[3 * k] + half[3 * i + 1] * own->R[3 * k + 1] + half[3 * i + 2] * own->R[3 * k + 2];
        }
        total[i] = s[i] + child->m * own->p[i];
    }
    const double *p = own->p;
    const double trace = p[0] * (s[0] + total[0]) + p[1] * (s[1] + total[1]) + p[2] * (s[2] + total[2]);
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
            carrier->I[3 * i + k] += I[3 * i + k] - (p[i] * total[k] + s[i] * p[k]);
        }
        carrier->I[4 * i] += trace;
        carrier->s[i] += total[i];
        carrier->force[i] += force[i];
        carrier->moment[i] += moment[i] + lever[i];
    }
    carrier->m += child->m;
}

static void inertia(const chain *table, const motion *moving, const body *bodies, double *M, double *f_G)
{
    const int n = table->links;
    memset(M, 0, sizeof(double) * (size_t)(n * n));
    for (int k = 0; k < n; ++k) {
        const body *b = &bodies[k];
        double force[3], moment[3], g[3];
        if (table->frames[k].type == 1) {
            force[0] = force[1] = 0.0;
            force[2] = b->m;
            moment[0] = b->s[1];
            moment[1] = -b->s[0];
            moment[2] = 0.0;
        } else {
            force[0] = -b->s[1];
            force[1] = b->s[0];
            force[2] = 0.0;
            moment[0] = b->I[2];
            moment[1] = b->I[5];
            moment[2] = b->I[8];
        }
        turned_back(moving[k].R0, table->gravity, g);
        f_G[k] = force[0] * g[0] + force[1] * g[1] + force[2] * g[2];
        M[k * n + k] = table->frames[k].type == 1 ? force[2] : moment[2];
        for (int j = k; table->frames[j].parent >= 0;) {
            double moved_force[3], moved_moment[3], lever[3];
            turned(moving[j].R, force, moved_force);
            turned(moving[j].R, moment, moved_moment);
            cross(moving[j].p, moved_force, lever);
            for (int i = 0; i < 3; ++i) {
                force[i] = moved_force[i];
                moment[i] = moved_moment[i] + lever[i];
            }
            j = table->frames[j].parent;
            M[j * n + k] = M[k * n + j] = table->frames[j].type == 1 ? force[2] : moment[2];
        }
    }
}

void table_driven(const chain *table, const double *q, const double *qd, double *phi, double *J, double *gamma, double *M,
    double *f_C, double *f_G)
{
    static const motion base = {.R0 = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    motion moving[MOST_FRAMES];
    body bodies[MOST_LINKS];
    const int n = table->links, count = n + 2 * table->cuts;
    for (int k = 0; k < count; ++k) {
        const frame *f = &table->frames[k];
        const motion *carrier = f->parent < 0 ? &base : &moving[f->parent];
        moved(f, k < n ? q[k] : 0.0, k < n ? qd[k] : 0.0, carrier, &moving[k]);
    }
    for (int cut = 0; cut < table->cuts; ++cut) {
        closed(table, moving, cut, phi + 6 * cut, J + 6 * n * cut, gamma + 6 * cut);
    }
    for (int k = 0; k < n; ++k) {
        own_body(&table->frames[k], &moving[k], &bodies[k]);
    }
    for (int k = n - 1; k >= 0; --k) {
        f_C[k] = table->frames[k].type == 1 ? bodies[k].force[2] : bodies[k].moment[2];
        if (table->frames[k].parent >= 0) {
            added(&moving[k], &bodies[k], &bodies[table->frames[k].parent]);
        }
    }
    inertia(table, moving, bodies, M, f_G);
}
