/* Drives every function of the C library for tests/bindings/test_c.py.
 *
 * usage: library SIGNERS QUESTION < PATHS   prints for each path the code, the report, and all numbers as hexadecimal
 *        library                            calls every function with arguments that cannot be used
 *        library threads PASSPORT SIGNERS QUESTION
 */
#include "dtg_passport.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *KEYS[] = {"delta", "b_deg_per_h", "c_deg_per_h_per_g", "n1",
                             "n2", "n2_inverse", "omega1_deg_per_h", "omega2_deg_per_h"};

/* Fails also where assert would be compiled away. */
static void expect(int holds, const char *what) {
    if (!holds) {
        fprintf(stderr, "not so: %s\n", what);
        exit(9);
    }
}
#define EXPECT(condition) expect(condition, #condition)

static void show(const char *path, const char *signers, const char *question) {
    dtg_passport *passport = (dtg_passport *)&passport;
    char *report = NULL;
    int code = dtg_load(path, signers, question, &passport, &report);
    EXPECT((code == DTG_OK) == (passport != NULL));
    /* The report is JSON of several lines; its length says where it ends. */
    printf("%d %zu\n%s\n", code, strlen(report), report);
    dtg_string_free(report);
    for (size_t key = 0; passport != NULL && key < sizeof KEYS / sizeof *KEYS; key++) {
        double m[4];
        EXPECT(dtg_matrix(passport, KEYS[key], m) == DTG_OK);
        printf("%a %a %a %a\n", m[0], m[1], m[2], m[3]);
    }
    size_t count = dtg_positions(passport);
    for (size_t k = 0; k < count; k++) {
        uint32_t ij[2];
        double n[2], omega[2];
        EXPECT(dtg_position(passport, k, ij, n, omega) == DTG_OK);
        printf("%u %u %a %a %a %a\n", (unsigned)ij[0], (unsigned)ij[1], n[0], n[1], omega[0], omega[1]);
    }
    puts("end");
    dtg_free(passport);
}

static void misuse(void) {
    dtg_passport *passport = (dtg_passport *)&passport;
    char *text = NULL;
    double numbers[4];
    uint32_t ij[2];
    EXPECT(dtg_load(NULL, NULL, NULL, NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_load("a", "b", "c", &passport, NULL) == DTG_UNUSABLE && passport == NULL);
    EXPECT(dtg_load("a", "b", NULL, NULL, &text) == DTG_UNUSABLE && strstr(text, "out is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_load("nowhere", "nowhere", NULL, &passport, &text) == DTG_UNUSABLE && strstr(text, "\"error\""));
    dtg_string_free(text);
    EXPECT(dtg_load("\xff\xfe", "/", "\xff", &passport, &text) == DTG_UNUSABLE && strstr(text, "UTF-8"));
    dtg_string_free(text);
    EXPECT(dtg_load("/dev/null", "/dev/null", "{}", &passport, &text) == DTG_UNUSABLE && strstr(text, "expected a file"));
    dtg_string_free(text);
    EXPECT(dtg_loads("", "", NULL, NULL, &text) == DTG_UNUSABLE && strstr(text, "out is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_loads(NULL, "", NULL, &passport, &text) == DTG_UNUSABLE && strstr(text, "passport is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_loads("\xff", NULL, NULL, &passport, &text) == DTG_UNUSABLE && strstr(text, "allowed_signers is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_loads("", "\xff", NULL, &passport, &text) == DTG_UNUSABLE && strstr(text, "\"allowed_signers"));
    dtg_string_free(text);
    EXPECT(dtg_loads("", "", "{\"serial\": null}", &passport, &text) == DTG_UNUSABLE && strstr(text, "serial: found null"));
    dtg_string_free(text);
    EXPECT(dtg_loads("\xff", "", NULL, &passport, &text) != DTG_OK && passport == NULL);
    dtg_string_free(text);
    EXPECT(dtg_matrix(NULL, "delta", numbers) == DTG_UNUSABLE);
    EXPECT(dtg_matrix(NULL, NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_positions(NULL) == 0);
    EXPECT(dtg_content(NULL) == NULL && dtg_sha256(NULL) == NULL && strlen(dtg_version()) > 0);
    EXPECT(dtg_array(NULL, "gravity", numbers, 1) == DTG_UNUSABLE && dtg_covariance(NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_position(NULL, 0, ij, numbers, numbers) == DTG_UNUSABLE);
    EXPECT(dtg_calibrate(NULL, numbers, 1, NULL, &text) == DTG_UNUSABLE && strstr(text, "passport is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_calibrate(NULL, NULL, (size_t)-1, NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_calibrate_csv(NULL, NULL, NULL, NULL) == DTG_UNUSABLE);
    dtg_free(NULL);
    dtg_string_free(NULL);
    puts("misused");
}

static void misuse_of(dtg_passport *passport) {
    char *text = NULL;
    double numbers[8] = {1, 1, 0.1, 0.2, 1, 2, 0.3, 0.1};
    uint32_t ij[2];
    EXPECT(dtg_matrix(passport, "Delta", numbers) == DTG_UNUSABLE);
    EXPECT(dtg_matrix(passport, "delta", NULL) == DTG_UNUSABLE);
    EXPECT(dtg_array(passport, "gravity", NULL, 1) == DTG_UNUSABLE && dtg_array(passport, "gravity", numbers, 2) == DTG_UNUSABLE);
    text = dtg_content(passport);
    EXPECT(text != NULL && strstr(text, "b_deg_per_h"));
    dtg_string_free(text);
    EXPECT(dtg_position(passport, dtg_positions(passport), ij, numbers, numbers) == DTG_UNUSABLE);
    EXPECT(dtg_position(passport, 0, NULL, numbers, numbers) == DTG_UNUSABLE);
    EXPECT(dtg_calibrate(passport, NULL, 2, NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_calibrate(passport, numbers, (size_t)-1, NULL, NULL) == DTG_UNUSABLE);
    EXPECT(dtg_calibrate(passport, numbers, 2, "exact", &text) == DTG_UNUSABLE && strstr(text, "method: found"));
    dtg_string_free(text);
    EXPECT(dtg_calibrate(passport, numbers, 2, NULL, &text) == DTG_REFUSED && strstr(text, "\"refused\""));
    dtg_string_free(text);
    EXPECT(dtg_calibrate_csv(passport, NULL, "{}", &text) == DTG_UNUSABLE && strstr(text, "currents_csv is NULL"));
    dtg_string_free(text);
    EXPECT(dtg_calibrate_csv(passport, "", NULL, &text) == DTG_UNUSABLE && strstr(text, "\"unreadable\""));
    dtg_string_free(text);
    EXPECT(dtg_calibrate_csv(passport, "\xff", "\xff", &text) == DTG_UNUSABLE && strstr(text, "UTF-8"));
    dtg_string_free(text);
    numbers[2] = 1e9; /* mA, beyond the range of any meter */
    EXPECT(dtg_calibrate(passport, numbers, 2, NULL, &text) == DTG_UNUSABLE && strstr(text, "\"column\""));
    dtg_string_free(text);
}

enum { THREADS = 8, ROUNDS = 20 };
static const char *path, *signers, *question;
static dtg_passport *shared;

/* Loads a passport of its own, and calibrates with the one that all threads share. */
static void *work(void *result) {
    for (int round = 0; round < ROUNDS; round++) {
        dtg_passport *own = NULL;
        EXPECT(dtg_load(path, signers, question, &own, NULL) == DTG_OK);
        dtg_free(own);
        double rows[8][4];
        for (size_t k = 0; k < 8; k++) {
            uint32_t ij[2];
            double n[2], omega[2];
            EXPECT(dtg_position(shared, k, ij, n, omega) == DTG_OK);
            double row[4] = {ij[0], ij[1], omega[0] / 95 + 0.01, omega[1] / 95 + 0.02};
            memcpy(rows[k], row, sizeof row);
        }
        char *json = NULL;
        EXPECT(dtg_calibrate(shared, rows[0], 8, "analytic", &json) == DTG_OK);
        char **due = result;
        if (*due == NULL) {
            *due = json;
        } else {
            EXPECT(strcmp(*due, json) == 0);
            dtg_string_free(json);
        }
    }
    return NULL;
}

int main(int argc, char **argv) {
    if (argc == 1) {
        misuse();
    } else if (argc == 3) {
        static char line[4096];
        while (fgets(line, sizeof line, stdin) != NULL) {
            line[strcspn(line, "\n")] = 0;
            show(line, argv[1], argv[2]);
        }
    } else {
        path = argv[2], signers = argv[3], question = argv[4];
        EXPECT(dtg_load(path, signers, question, &shared, NULL) == DTG_OK);
        misuse_of(shared);
        pthread_t threads[THREADS];
        char *results[THREADS] = {NULL};
        for (int k = 0; k < THREADS; k++) {
            EXPECT(pthread_create(&threads[k], NULL, work, &results[k]) == 0);
        }
        for (int k = 0; k < THREADS; k++) {
            pthread_join(threads[k], NULL);
        }
        for (int k = THREADS - 1; k >= 0; k--) {
            EXPECT(strcmp(results[0], results[k]) == 0);
            dtg_string_free(results[k]);
        }
        dtg_free(shared);
        puts("threads agree");
    }
    return 0;
}
