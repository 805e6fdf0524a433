/* Verifies a passport and calibrates a gyro with it, by the library and by the paper's equation (13).
 *
 *     gcc calibrate.c -I.. -L../../target/release -ldtg_passport -o calibrate
 *     ./calibrate PASSPORT ALLOWED_SIGNERS QUESTION_JSON < CURRENTS
 *
 * Each line of CURRENTS has i, j, jx_ma and jy_ma. Exit code: 0 done, 1 refused, 2 unusable.
 */
#include "dtg_passport.h"

#include <stdio.h>

enum { MOST_ROWS = 1024 };

int main(int argc, char **argv) {
    if (argc != 4) {
        fprintf(stderr, "usage: %s PASSPORT ALLOWED_SIGNERS QUESTION_JSON\n", argv[0]);
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

    double rows[MOST_ROWS][4];
    size_t count = 0;
    while (count < MOST_ROWS &&
           scanf("%lf ,%lf ,%lf ,%lf", &rows[count][0], &rows[count][1], &rows[count][2], &rows[count][3]) == 4) {
        count++;
    }
    char *result = NULL;
    code = dtg_calibrate(passport, rows[0], count, "least-squares", &result);
    puts(result);
    dtg_string_free(result);

    /* K = B (J_1 - J_2 delta)^-1, eq. (13): columns are differences of opposite positions, eq. (11). */
    double b[4], delta[4], j[2][4][2] = {{{0}}}, m[2][2];
    if (code == DTG_OK && dtg_matrix(passport, "b_deg_per_h", b) == DTG_OK &&
        dtg_matrix(passport, "delta", delta) == DTG_OK) {
        for (size_t k = 0; k < count; k++) {
            if (rows[k][0] <= 2 && rows[k][1] <= 4) {
                double *at = j[(int)rows[k][0] - 1][(int)rows[k][1] - 1];
                at[0] = rows[k][2];
                at[1] = rows[k][3];
            }
        }
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
