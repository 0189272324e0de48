/*
 * Checks, counts and times candidates that do the same work.
 *
 * Compiled with table.c, which names the candidates, and linked with one object of each; nothing is inlined across
 * objects. Inputs: a file of doubles, POSES times the arguments, each at an offset of PLACE[] within STRIDE doubles.
 *
 *   harness check POSES_FILE           writes all outputs of every candidate at every pose to stdout, as doubles
 *   harness count POSES_FILE           calls every candidate once at every pose, for callgrind
 *   harness step POSES_FILE            writes the instructions per call of every candidate, counted by single steps:
 *                                      for processors whose instructions callgrind does not know; Linux only
 *   harness time POSES_FILE ROUNDS N   writes ROUNDS lines of ns per call, one number a candidate: N passes over the
 *                                      poses each, candidates interleaved, the first one another in each round
 */
#define _DEFAULT_SOURCE
#include "table.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __linux__
#include <signal.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

enum { STEPPED_POSES = 8 };

static _Alignas(64) double inputs[POSES * STRIDE];
static _Alignas(64) double outputs[OUTPUT_STRIDE];

__attribute__((noinline)) void call_all(routine *f, int poses)
{
    for (int pose = 0; pose < poses; ++pose) {
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
            call_all(candidates[chosen], POSES);
            const double start = now();
            for (int pass = 0; pass < passes; ++pass) call_all(candidates[chosen], POSES);
            ns[chosen] = (now() - start) / ((double)passes * POSES);
        }
        for (int k = 0; k < CANDIDATES; ++k) printf("%.3f%c", ns[k], k + 1 < CANDIDATES ? ' ' : '\n');
    }
}

#ifdef __linux__
static void nothing(const double *r_i, const double *A_i, const double *r_j, const double *A_j, const double *geometry,
                    const double *lambda, double *phi, double *phi_q, double *phi_q_t_lambda_q)
{
    (void)r_i, (void)A_i, (void)r_j, (void)A_j, (void)geometry, (void)lambda, (void)phi, (void)phi_q;
    (void)phi_q_t_lambda_q;
}

/* The child says what it is calling, 0 is nothing and the measure of the calls themselves; the parent steps. */
static int step(void)
{
    static long steps[CANDIDATES + 2];
    volatile int *const current = mmap(NULL, sizeof(int), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    const pid_t child = fork();
    if (child == 0) {
        if (ptrace(PTRACE_TRACEME, 0, 0, 0) || raise(SIGSTOP)) _exit(EXIT_FAILURE);
        for (int k = 0; k <= CANDIDATES; ++k) {
            routine *volatile f = k ? candidates[k - 1] : nothing;
            *current = k;
            call_all(f, STEPPED_POSES);
        }
        *current = CANDIDATES + 1;
        _exit(EXIT_SUCCESS);
    }
    int status = 0;
    waitpid(child, &status, 0);
    while (WIFSTOPPED(status)) {
        if (ptrace(PTRACE_SINGLESTEP, child, 0, 0)) return EXIT_FAILURE;
        waitpid(child, &status, 0);
        ++steps[*current];
    }
    for (int k = 1; k <= CANDIDATES; ++k)
        printf("%.2f\n", 1.0 + (double)(steps[k] - steps[0]) / STEPPED_POSES);
    return WEXITSTATUS(status);
}
#endif

int main(int argc, char **argv)
{
    FILE *const file = argc > 2 ? fopen(argv[2], "rb") : NULL;
    if (!file || fread(inputs, sizeof(double), POSES * STRIDE, file) != POSES * STRIDE) return EXIT_FAILURE;
    fclose(file);
    if (!strcmp(argv[1], "check")) check();
    if (!strcmp(argv[1], "count"))
        for (int k = 0; k < CANDIDATES; ++k) call_all(candidates[k], POSES);
    if (!strcmp(argv[1], "time")) measure(atoi(argv[3]), atoi(argv[4]));
#ifdef __linux__
    if (!strcmp(argv[1], "step")) return step();
#endif
    return EXIT_SUCCESS;
}
