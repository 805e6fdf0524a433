/* Verifies a passport and calibrates a gyro with it, by the library and by the paper's equation (13).
 *
 *     ./calibrate PASSPORT ALLOWED_SIGNERS QUESTION_JSON < CURRENTS.csv
 *
 * Exit code: 0 done, 1 refused, 2 unusable.
 */
#include "dtg_passport.h"

#include <stdio.h>
#include <string.h>

enum { MOST_ROWS = 1024 };

/* Reads rows i, j, jx_ma, jy_ma after an optional header. Returns their number, or 0 after a message. */
static size_t read_rows(double rows[MOST_ROWS][4]) {
    static const char header[] = "i,j,jx_ma,jy_ma";
    char line[256], rest;
    size_t count = 0;
    for (int number = 1; fgets(line, sizeof line, stdin) != NULL; number++) {
        if (line[0] == '#' || line[strspn(line, " \t\r\n")] == '\0' || strncmp(line, header, sizeof header - 1) == 0) {
            continue;
        }
        double *at = rows[count];
        if (sscanf(line, "%lf ,%lf ,%lf ,%lf %c", &at[0], &at[1], &at[2], &at[3], &rest) != 4 || ++count == MOST_ROWS) {
            fprintf(stderr, "line %d: expected %s, in fewer than %d rows\n", number, header, MOST_ROWS);
            return 0;
        }
    }
    if (count == 0) {
        fprintf(stderr, "standard input: expected rows of %s\n", header);
    }
    return count;
}

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: %s PASSPORT ALLOWED_SIGNERS QUESTION_JSON < CURRENTS.csv\n", argv[0]);
        return DTG_UNUSABLE;
    }
    static double rows[MOST_ROWS][4];
    size_t count = read_rows(rows);
    if (count == 0) {
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
    code = dtg_calibrate(passport, rows[0], count, "least-squares", &result);
    puts(result);
    double value[8], u[8]; /* K_x, K_xy, K_yx, K_y, omega_0x, omega_0y, omega_g, omega_k */
    if (code == DTG_OK && dtg_parameters(result, value, u) == DTG_REFUSED) {
        fputs("WARNING: do not use these parameters; the remarks of the result say why\n", stderr);
    }
    dtg_string_free(result);

    /* K = B (J_1 - J_2 delta)^-1, eq. (13): columns are differences of opposite positions, eq. (11). */
    double b[4], delta[4], j[2][4][2], m[2][2];
    unsigned read = 0; /* a bit for each of the eight positions */
    for (size_t k = 0; code == DTG_OK && k < count; k++) {
        if (rows[k][0] <= 2 && rows[k][1] <= 4) {
            int frame = (int)rows[k][0] - 1, platform = (int)rows[k][1] - 1;
            memcpy(j[frame][platform], &rows[k][2], sizeof j[frame][platform]);
            read |= 1U << (4 * frame + platform);
        }
    }
    if (read == 0xff && dtg_matrix(passport, "b_deg_per_h", b) == DTG_OK &&
        dtg_matrix(passport, "delta", delta) == DTG_OK) {
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
                printf("%.6f ", b[2 * row] * inverse[0][column] + b[2 * row + 1] * inverse[1][column]);
            }
        }
        puts("deg/(h*mA)");
    }
    dtg_free(passport);
    return code;
}
