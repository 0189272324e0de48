/*
 * Checks, counts and times candidates that do the same work.
 *
 * Compiled with table.c, which names the candidates, and linked with one object of each; nothing is inlined across
 * objects. Inputs: a file of doubles, POSES times the arguments, each at an offset of PLACE[] within STRIDE doubles.
 *
 *   harness check POSES_FILE           writes all outputs of every candidate at every pose to stdout, as doubles
 *   harness count POSES_FILE           calls every candidate once at every pose, for an instruction counter
 *   harness time POSES_FILE ROUNDS N   writes ROUNDS lines of ns per call, one number a candidate: N passes over the
 *                                      poses each, candidates interleaved, the first one another in each round
 */
#define _POSIX_C_SOURCE 200809L
#include "table.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static _Alignas(64) double inputs[POSES * STRIDE];
static _Alignas(64) double outputs[OUTPUT_STRIDE];

__attribute__((noinline)) void call_all(routine *f)
{
    for (int pose = 0; pose < POSES; ++pose) {
        const double *const x = inputs + STRIDE * pose;
        f(x + PLACE[0], x + PLACE[1], x + PLACE[2], x + PLACE[3], x + PLACE[4], x + PLACE[5], outputs + OUTPUT_PLACE[0],
          outputs + OUTPUT_PLACE[1], outputs + OUTPUT_PLACE[2]);
    }
}

static void check(void)
{
    for (int k = 0; k < CANDIDATES; ++k) {
        for (int pose = 0; pose < POSES; ++pose) {
            const double *const x = inputs + STRIDE * pose;
            for (int n = 0; n < OUTPUT_STRIDE; ++n) outputs[n] = 0.0 / 0.0;
            candidates[k](x + PLACE[0], x + PLACE[1], x + PLACE[2], x + PLACE[3], x + PLACE[4], x + PLACE[5],
                          outputs + OUTPUT_PLACE[0], outputs + OUTPUT_PLACE[1], outputs + OUTPUT_PLACE[2]);
            fwrite(outputs, sizeof(double), OUTPUT_STRIDE, stdout);
        }
    }
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void measure(int rounds, int passes)
{
    double ns[CANDIDATES];
    for (int round = 0; round < rounds; ++round) {
        for (int k = 0; k < CANDIDATES; ++k) {
            const int chosen = (k + round) % CANDIDATES;
            call_all(candidates[chosen]);
            const double start = now();
            for (int pass = 0; pass < passes; ++pass) call_all(candidates[chosen]);
            ns[chosen] = (now() - start) / ((double)passes * POSES);
        }
        for (int k = 0; k < CANDIDATES; ++k) printf("%.3f%c", ns[k], k + 1 < CANDIDATES ? ' ' : '\n');
    }
}

int main(int argc, char **argv)
{
    FILE *const file = argc > 2 ? fopen(argv[2], "rb") : NULL;
    if (!file || fread(inputs, sizeof(double), POSES * STRIDE, file) != POSES * STRIDE) return EXIT_FAILURE;
    fclose(file);
    if (!strcmp(argv[1], "check")) check();
    if (!strcmp(argv[1], "count"))
        for (int k = 0; k < CANDIDATES; ++k) call_all(candidates[k]);
    if (!strcmp(argv[1], "time")) measure(atoi(argv[3]), atoi(argv[4]));
    return EXIT_SUCCESS;
}
