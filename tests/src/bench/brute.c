/* Brute force as a plain C program has it: for every ray every triangle, the plane first, then whether its point lies inside.
   brute TRIANGLES RAYS LEAVES HITS: nine floats a triangle; eight a ray (origin, tmin, direction, tmax); the number of the triangle
   that a ray leaves, -1 for none, which is skipped; t and triangle number of each answer. Prints the seconds that tracing took. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct { float x, y, z; } Vec;
typedef struct { Vec a, b, c, n; float d; } Triangle;
typedef struct { Vec o; float tmin; Vec d; float tmax; } Ray;
typedef struct { float t; int triangle; } Hit;

static Vec minus(Vec a, Vec b) { return (Vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static Vec cross(Vec a, Vec b) { return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/* Whether p, a point of the plane of n, lies on the inner side of the edge from a to b. */
static int inside(Vec a, Vec b, Vec p, Vec n) { return dot(cross(minus(b, a), minus(p, a)), n) >= 0; }

static void *slurp(const char *name, size_t size, size_t *count) {
    FILE *file = fopen(name, "rb");
    if (!file) { perror(name); exit(1); }
    fseek(file, 0, SEEK_END);
    *count = (size_t)ftell(file) / size;
    rewind(file);
    void *data = malloc(*count * size + 1);
    if (!data || fread(data, size, *count, file) != *count) { perror(name); exit(1); }
    fclose(file);
    return data;
}

static Hit trace(const Triangle *triangles, int n, Ray ray, int leaves) {
    Hit best = {ray.tmax, -1};
    for (int i = 0; i < n; i++) {
        const Triangle *tri = &triangles[i];
        float along = dot(tri->n, ray.d);
        if (along == 0 || i == leaves) continue;
        float t = (tri->d - dot(tri->n, ray.o)) / along;
        if (t <= ray.tmin || t >= best.t) continue;
        Vec p = {ray.o.x + t * ray.d.x, ray.o.y + t * ray.d.y, ray.o.z + t * ray.d.z};
        if (inside(tri->a, tri->b, p, tri->n) && inside(tri->b, tri->c, p, tri->n) && inside(tri->c, tri->a, p, tri->n))
            best = (Hit){t, i};
    }
    return best;
}

int main(int argc, char **argv) {
    if (argc != 5) { fprintf(stderr, "brute TRIANGLES RAYS LEAVES HITS\n"); return 2; }
    size_t n, count, leaving;
    Vec (*corners)[3] = slurp(argv[1], sizeof *corners, &n);
    Ray *rays = slurp(argv[2], sizeof *rays, &count);
    int *leaves = slurp(argv[3], sizeof *leaves, &leaving);
    if (leaving != count) { fprintf(stderr, "%zu rays, %zu of them leave a triangle or none\n", count, leaving); return 1; }
    Triangle *triangles = malloc(n * sizeof *triangles + 1);
    Hit *hits = malloc(count * sizeof *hits + 1);
    for (size_t i = 0; i < n; i++) {
        Triangle *tri = &triangles[i];
        tri->a = corners[i][0], tri->b = corners[i][1], tri->c = corners[i][2];
        tri->n = cross(minus(tri->b, tri->a), minus(tri->c, tri->a));
        tri->d = dot(tri->n, tri->a);
    }
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    for (size_t i = 0; i < count; i++) hits[i] = trace(triangles, (int)n, rays[i], leaves[i]);
    clock_gettime(CLOCK_MONOTONIC, &to);
    FILE *file = fopen(argv[4], "wb");
    if (!file || fwrite(hits, sizeof *hits, count, file) != count || fclose(file)) { perror(argv[4]); return 1; }
    printf("%.9f\n", (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec));
    return 0;
}
