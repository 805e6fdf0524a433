/* Verifies a passport and calibrates a gyro with it, by the library and by the paper's equation (13).
 *
 *     ./calibrate PASSPORT ALLOWED_SIGNERS QUESTION_JSON [ORDER_JSON] < CURRENTS.csv
 *
 * Exit code: 0 done, 1 refused, 2 unusable.
 */
#include "dtg_passport.h"

#include <stdio.h>
#include <string.h>

/* Computes K = B (J_1 - J_2 delta)^-1, eq. (13), from one reading of each position; returns 0 if one has none or several, or
 * if the columns do not begin with i, j, J_x, J_y. */
static int paper_k(const dtg_passport *passport, const char *csv, double k[2][2]) {
    double b[4], delta[4], j[2][4][2], m[2][2];
    unsigned read = 0; /* a bit for each of the eight positions */
    const char *header = csv;
    while (header != NULL && *header == '#') {
        header = strchr(header, '\n');
        header += header != NULL;
    }
    if (header == NULL || strncmp(header, "i,j,jx_ma,jy_ma", 15) != 0) {
        return 0;
    }
    for (const char *line = header; line != NULL; line = strchr(line, '\n'), line += line != NULL) {
        unsigned frame, platform;
        double x, y;
        if (sscanf(line, "%u ,%u ,%lf ,%lf", &frame, &platform, &x, &y) == 4 && frame - 1 < 2 && platform - 1 < 4) {
            unsigned bit = 1U << (4 * (frame - 1) + platform - 1);
            if (read & bit) {
                return 0;
            }
            read |= bit;
            j[frame - 1][platform - 1][0] = x;
            j[frame - 1][platform - 1][1] = y;
        }
    }
    if (read != 0xff || dtg_matrix(passport, "b_deg_per_h", b) != DTG_OK ||
        dtg_matrix(passport, "delta", delta) != DTG_OK) {
        return 0;
    }
    /* Columns are differences of opposite positions, eq. (11). */
    for (int row = 0; row < 2; row++) {
        double j2[2] = {j[1][0][row] - j[1][2][row], j[1][1][row] - j[1][3][row]};
        for (int column = 0; column < 2; column++) {
            double j1 = j[0][column][row] - j[0][column + 2][row];
            m[row][column] = j1 - (j2[0] * delta[column] + j2[1] * delta[2 + column]);
        }
    }
    double d = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    double inverse[2][2] = {{m[1][1] / d, -m[0][1] / d}, {-m[1][0] / d, m[0][0] / d}};
    for (int row = 0; row < 2; row++) {
        for (int column = 0; column < 2; column++) {
            k[row][column] = b[2 * row] * inverse[0][column] + b[2 * row + 1] * inverse[1][column];
        }
    }
    return 1;
}

int main(int argc, char **argv) {
    static char csv[1 << 20];
    if (argc < 4 || argc > 5) {
        fprintf(stderr, "usage: %s PASSPORT ALLOWED_SIGNERS QUESTION_JSON [ORDER_JSON] < CURRENTS.csv\n", argv[0]);
        return DTG_UNUSABLE;
    }
    if (fread(csv, 1, sizeof csv - 1, stdin) == sizeof csv - 1) {
        fputs("standard input: expected less than 1 MiB\n", stderr);
        return DTG_UNUSABLE;
    }

    dtg_passport *passport = NULL;
    char *report = NULL;
    int code = dtg_load(argv[1], argv[2], argv[3], &passport, &report);
    puts(report);
    dtg_string_free(report);
    if (code != DTG_OK) {
        return code;
    }

    char *result = NULL;
    code = dtg_calibrate_csv(passport, csv, argc == 5 ? argv[4] : NULL, &result);
    puts(result);
    double value[8], u[8]; /* k_x, k_xy, k_yx, k_y, omega_0x, omega_0y, omega_g, omega_k */
    int usable = code == DTG_OK && dtg_parameters(result, value, u) == DTG_OK;
    if (code == DTG_REFUSED) {
        fputs("do not use these parameters; the remarks of the result say why\n", stderr);
    }
    dtg_string_free(result);

    double k[2][2];
    if (usable && argc == 4 && paper_k(passport, csv, k)) { /* an order may exclude visits */
        printf("%.6f %.6f %.6f %.6f deg/(h*mA)\n", k[0][0], k[0][1], k[1][0], k[1][1]);
    }
    dtg_free(passport);
    return code;
}
