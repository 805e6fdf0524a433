//! Texts of the calibration report.

use super::texts;

texts! {
    TITLE { en: "Calibration of a dynamically tuned gyro", ru: "Калибровка динамически настраиваемого гироскопа" }
    NAME { en: "{gyro}, currents {sha256}", ru: "{gyro}, токи {sha256}" }
    GYRO_NOT_STATED { en: "Type and serial number not stated", ru: "Тип и номер не указаны" }
    SUBTITLE {
        en: "Scale factors and drifts in case axes, determined from the torquer currents in the positions of a \
             certified stand",
        ru: "Масштабные коэффициенты и составляющие дрейфа в осях корпуса, найденные по токам датчиков момента в \
             положениях откалиброванного стенда"
    }
    MARGIN { en: "Calibration report: {name}", ru: "Отчёт о калибровке: {name}" }
    MARGIN_SHA256 { en: "SHA-256 of the file of currents {sha256}", ru: "SHA-256 файла токов {sha256}" }
    END { en: "End of the calibration report: {name}", ru: "Конец отчёта: {name}" }

    NOT_VERIFIED { en: "Passport NOT VERIFIED", ru: "Паспорт НЕ ПРОВЕРЕН" }
    NOT_VERIFIED_WORDS {
        en: "The origin of the passport has not been verified, and its numbers may be wrong. The results below are not \
             valid until the passport has been verified.",
        ru: "Подлинность паспорта не проверена, его данные могут быть недостоверны. Приведённые ниже результаты \
             недействительны, пока паспорт не проверен."
    }
    DOES_NOT_FIT {
        en: "The readings are not consistent with this stand",
        ru: "Показания не согласуются с этим стендом"
    }
    DOES_NOT_FIT_WORDS {
        en: "The parameters are not valid. Find the cause and repeat the calibration.",
        ru: "Найденные параметры недействительны. Следует выяснить причину и повторить калибровку."
    }
    CONFORMS { en: "Within the tolerances of gyro type {type}", ru: "Соответствует допускам типа {type}" }
    CONFORMS_NOT { en: "NOT within the tolerances of gyro type {type}", ru: "НЕ соответствует допускам типа {type}" }
    CHANGED_TOO_MUCH {
        en: "NOT stable within the tolerances of gyro type {type}",
        ru: "Изменение НЕ соответствует допускам типа {type}"
    }
    CHANGE_UNDECIDED {
        en: "Within the tolerances of gyro type {type}; conformity of the change is undecided",
        ru: "Соответствует допускам типа {type}; соответствие изменения не определено"
    }
    UNITS { en: "; units {units}", ru: "; единицы {units}" }
    NO_STATEMENT {
        en: "No statement of conformity with gyro type {type}",
        ru: "Заключение о соответствии типу {type} не приводится"
    }
    UNDECIDED { en: "Conformity with gyro type {type} is undecided", ru: "Соответствие типу {type} не определено" }
    RULE {
        en: "Decision rule (JCGM 106, 8.3): pass if |deviation|\u{a0}+\u{a0}U ≤ tolerance, fail if |deviation|\u{a0}−\u{a0}U > tolerance, otherwise \
             undecided; a smaller U could decide it.",
        ru: "Правило принятия решения (JCGM 106, 8.3): соответствует при |отклонение|\u{a0}+\u{a0}U ≤ допуск, не соответствует при \
             |отклонение|\u{a0}−\u{a0}U > допуск, иначе не определено; решение возможно при меньшей U."
    }
    NOT_IN_U {
        en: "Inputs not included in U (u not stated, or stated as 0): {count} (section\u{a0}3){more}.",
        ru: "Величин, не учтённых в U (u не указана или равна 0): {count} (раздел\u{a0}3){more}."
    }
    METER_IS_ASSUMED {
        en: "The error of the current meter is assumed: ±0.015\u{a0}% of the reading.",
        ru: "Погрешность измерителя тока принята: ±0,015\u{a0}% показания."
    }
    AND_TEMPERATURE { en: ", and the temperature", ru: "; не учтена и температура" }
    NO_TYPE {
        en: "Parameters determined, conformity not assessed",
        ru: "Параметры определены, соответствие не оценивалось"
    }
    NO_TYPE_WORDS {
        en: "No gyro type was specified; this report makes no statement of conformity.",
        ru: "Тип гироскопа не указан; заключение о соответствии не приводится."
    }
    NOT_TESTED {
        en: "Without a gyro type these errors are not recognised: columns of currents that are exchanged or reversed, a unit of \
             the currents that is wrong by a factor below a thousand, a passport of another site, a rotated gyro or base, and \
             positions numbered differently.",
        ru: "Без типа гироскопа не распознаются перестановка токов x и y, обратный знак тока, неверная единица тока (менее чем \
             в тысячу раз), паспорт другого места установки, поворот гироскопа или основания и другая нумерация положений."
    }
    MISTAKE { en: "These are not the parameters of this gyro", ru: "Параметры не относятся к данному гироскопу" }
    MISTAKE_CURRENTS {
        en: "The readings fit, but the parameters do not match this gyro. This explains it: {causes}. Check the torquer \
             cables, the signs and unit of the currents, the gyro seat, and the values of the gyro type; then calibrate \
             again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется так: \
             {causes}. Следует проверить кабели датчиков момента, знаки и единицу токов, установку гироскопа, значения для \
             типа и повторить калибровку."
    }
    MISTAKE_PLACE {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: the passport is for \
             another site, and the stand is at a latitude of about {latitude}. Check the location of the stand; then \
             calibrate again with the passport for that site.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: стенд находится на широте около {latitude}, а паспорт выдан для другого места установки. Следует \
             проверить место установки стенда и повторить калибровку по паспорту для этого места."
    }
    MISTAKE_GYRO_TURNED {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: the gyro is rotated by \
             {angle}° about its spin axis, or φ is counted from another position. Check the gyro seat; then calibrate \
             again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: гироскоп повёрнут вокруг оси собственного вращения на {angle}°, или угол φ отсчитан от другого \
             положения. Следует проверить установку гироскопа и повторить калибровку."
    }
    MISTAKE_ROTATED {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: the gyro is rotated in \
             its seat about the spin axis, or the base about the vertical, by about {angle}°. Check the gyro seat and the \
             azimuth of the base; then calibrate again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: гироскоп повёрнут на посадочной поверхности вокруг оси собственного вращения или основание — вокруг \
             вертикали примерно на {angle}°. Следует проверить установку гироскопа и азимут основания и повторить \
             калибровку."
    }
    MISTAKE_OTHER_AXIS {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: the axis of the \
             frame points to azimuth {azimuth}°, not to that of the passport. Check the set-up of the base; \
             then calibrate again, or request a passport for this azimuth.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: ось рамки стенда направлена по азимуту {azimuth}°, а не по указанному в паспорте. Следует проверить \
             выставку основания и повторить калибровку или запросить паспорт для этого азимута."
    }
    MISTAKE_TYPE_TOO_SMALL {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: all values of the gyro \
             type are too small by a factor of {factor} (about 3600 if they are in degrees per second). Correct the \
             gyro type; then calibrate again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: все значения типа гироскопа занижены в {factor} (примерно в 3600 раз, если указаны в градусах в \
             секунду). Следует исправить тип гироскопа и повторить калибровку."
    }
    MISTAKE_TYPE_TOO_LARGE {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: all values of the gyro \
             type are too large by a factor of {factor}. Correct the gyro type; then calibrate again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: все значения типа гироскопа завышены в {factor}. Следует исправить тип гироскопа и повторить \
             калибровку."
    }
    MISTAKE_RENUMBERED {
        en: "The readings fit, but the parameters do not match this gyro. One error explains this: the positions are \
             numbered in another way (readings → passport): {numbers}. Check the numbering and the direction of φ; then \
             calibrate again.",
        ru: "Показания согласуются с моделью, но параметры не соответствуют данному гироскопу. Это объясняется одной \
             ошибкой: положения пронумерованы иначе (показания → паспорт): {numbers}. Следует проверить нумерацию и \
             направление отсчёта φ и повторить калибровку."
    }
    MISTAKE_AND { en: "and", ru: "и" }
    MISTAKE_EXCHANGED { en: "the x and y columns are exchanged", ru: "столбцы x и y переставлены" }
    MISTAKE_X_REVERSED {
        en: "the sign of the x column is reversed",
        ru: "знаки значений столбца x изменены на обратные"
    }
    MISTAKE_Y_REVERSED {
        en: "the sign of the y column is reversed",
        ru: "знаки значений столбца y изменены на обратные"
    }
    MISTAKE_REVERSED {
        en: "the signs of both columns are reversed",
        ru: "знаки значений обоих столбцов изменены на обратные"
    }
    MISTAKE_MICROAMPERES {
        en: "the currents are in microamperes instead of milliamperes, or the expected scale factors are per ampere",
        ru: "токи указаны в микроамперах, а не в миллиамперах, либо ожидаемые масштабные коэффициенты отнесены к амперу"
    }
    MISTAKE_TOO_LARGE { en: "all currents are too large by a factor of {factor}", ru: "все токи завышены в {factor}" }
    MISTAKE_TOO_SMALL { en: "all currents are too small by a factor of {factor}", ru: "все токи занижены в {factor}" }

    NO_CHANGE { en: "Change cannot be assessed", ru: "Изменение установить нельзя" }
    SAME_READINGS {
        en: "The previous result is from these same readings, so it does not show a change. Compare with the result of \
             an earlier calibration.",
        ru: "Предыдущий результат получен по этим же показаниям и изменения не показывает. Следует сравнить с \
             результатом более ранней калибровки."
    }
    EARLIER_NOT_VALID {
        en: "The previous result is not valid: its readings did not fit the stand, or contained an error. Compare with a \
             valid result.",
        ru: "Предыдущий результат недействителен: его показания не согласуются со стендом или содержат ошибку. Следует \
             сравнить с действительным результатом."
    }
    EARLIER_SUSPECT {
        en: "A reading of the previous result is probably wrong, so it does not show a change. Repeat that calibration \
             without it.",
        ru: "Одно из показаний предыдущего результата, вероятно, ошибочно, и изменения он не показывает. Следует \
             повторить ту калибровку без этого показания."
    }
    EARLIER_NOT_VERIFIED {
        en: "The passport of the previous result was not verified, so no statement is made on the change. Repeat that \
             calibration with a verified passport.",
        ru: "Паспорт предыдущего результата не проверен, поэтому заключение об изменении не приводится. Следует повторить ту \
             калибровку с проверенным паспортом."
    }
    SUBJECT { en: "Object, place and equipment of the calibration", ru: "Объект, место и средства калибровки" }
    TYPE { en: "Type", ru: "Тип" }
    SERIAL { en: "Serial number of the gyro", ru: "Заводской номер гироскопа" }
    CONDITION { en: "Condition of the gyro", ru: "Состояние гироскопа" }
    RECEIVED { en: "Gyro received", ru: "Дата поступления" }
    MEASURED { en: "Date of the readings", ru: "Дата измерений" }
    REPORT_NUMBER { en: "Report number", ru: "Номер отчёта" }
    PROCEDURE { en: "Procedure and deviations from it", ru: "Методика и отступления от неё" }
    STAND { en: "Stand", ru: "Стенд" }
    VERIFIED_NOT_WITHDRAWAL {
        en: "Passport {id}, verified as of {time}; withdrawal not checked",
        ru: "Паспорт {id} проверен на\u{a0}{time}; отзыв не\u{a0}проверялся"
    }
    VERIFIED_AS_OF {
        en: "Passport {id}, verified as of {time}",
        ru: "Паспорт {id} проверен на\u{a0}{time}"
    }
    CURRENTS { en: "File of currents", ru: "Файл токов" }
    OPERATOR { en: "Readings taken by", ru: "Показания снял" }
    MEASURED_TEMPERATURE { en: "Temperature during the readings", ru: "Температура при снятии показаний" }
    EXCLUDED {
        en: "Visits left out (i, j, visit, turn-on)",
        ru: "Исключённые установки в положение (i, j, установка, запуск)"
    }
    LEFT_OUT { en: "Positions without a reading", ru: "Положения без показаний" }
    CURRENTS_SHA256 { en: "SHA-256 of the file of currents", ru: "SHA-256 файла токов" }
    PASSPORT { en: "Passport of the stand", ru: "Паспорт стенда" }
    PASSPORT_SHA256 { en: "SHA-256 of the passport", ru: "SHA-256 паспорта" }
    METER_IDENTITY {
        en: "Current meter: type, serial number, certificate",
        ru: "Измеритель тока: тип, номер, сертификат"
    }
    METER_ASSUMED {
        en: "No laboratory file states the current meter. This report assumes a meter with an error uniformly \
             distributed within ±0.015 % of the reading, and no other uncertainty of the laboratory.",
        ru: "Измеритель тока лаборатории не указан: принята погрешность ±0,015 % показания, распределённая \
             равномерно; другие составляющие, вносимые лабораторией, не учтены."
    }
    READINGS_ARE_OLDER {
        en: "The readings are older than the measurement of the stand",
        ru: "Показания сняты до измерения углов стенда"
    }
    READINGS_OLDER {
        en: "The readings are of {date}; the stand was measured for its certificate on {performed}. Nothing shows that it \
             agreed with the certificate on the earlier date.",
        ru: "Показания сняты {date}, а углы стенда для сертификата измерены {performed}. Ничто не подтверждает, что на \
             дату показаний стенд соответствовал сертификату."
    }
    TEMPERATURE_IS_OUTSIDE {
        en: "The temperature is outside the certified range",
        ru: "Температура вне диапазона, указанного в сертификате"
    }
    TEMPERATURE_OUTSIDE {
        en: "The temperature in the laboratory is {here} °C; the deviations of the stand are certified from {low} °C to \
             {high} °C. U does not include the effect of this: the decisions hold only if it is negligible.",
        ru: "Температура в лаборатории {here} °C; отклонения стенда по сертификату применимы при температуре от {low} до \
             {high} °C. Влияние этого в U не учтено: решения верны, только если оно пренебрежимо \
             мало."
    }

    PARAMETERS { en: "Parameters", ru: "Параметры" }
    RESULT { en: "Result", ru: "Результат" }
    RESULT_CAPTION {
        en: "Parameters with their expanded uncertainty U (coverage factor k = {k}; coverage probability 95.45 %); ω_g and \
             ω_k refer to local g",
        ru: "Параметры и их расширенная неопределённость U (коэффициент охвата k = {k}; вероятность охвата 95,45 %); \
             ω_g и ω_k отнесены к местному g"
    }
    PASSED { en: "{passed} of {all} parameters pass", ru: "Соответствие допускам: {passed} из {all} параметров" }
    CHANGE_PASSED {
        en: "Change since the previous calibration: {passed} of {all} parameters pass",
        ru: "Изменение после предыдущей калибровки соответствует допускам у {passed} из {all} параметров"
    }
    ARE_UNDECIDED { en: "; undecided: {names}", ru: "; не определено: {names}" }
    FAIL { en: "; fail: {names}", ru: "; несоответствие: {names}" }
    NOT_IN_THE_MODEL {
        en: "not assessed, because the general model does not contain them: {names}",
        ru: "не оценивались, так как их нет в общей модели: {names}"
    }
    PLUS_MINUS { en: "± U", ru: "± U" }
    IN_TOLERANCE { en: "% of the tolerance", ru: "% допуска" }
    METHODS { en: "Methods and convergence", ru: "Методы и сходимость" }
    NEGLIGIBLE { en: "a thousandth of u (negligible)", ru: "тысячной доли u (пренебрежимо мала)" }
    PARAMETERS_CAPTION {
        en: "Values, each with its standard uncertainty u (k = 1) below it; ω_g and ω_k refer to local g, {g} m/s²",
        ru: "Значения и под ними стандартная неопределённость u (k = 1); ω_g и ω_k отнесены к \
             местному g, {g} м/с²"
    }
    ADOPTED { en: "{method} (adopted result)", ru: "{method} (принятый результат)" }
    LEAST_SQUARES_NAME { en: "Weighted least squares", ru: "Взвешенный МНК" }
    ANALYTIC { en: "Analytic method", ru: "Аналитический метод" }
    ITERATIVE { en: "Iterative method", ru: "Итерационный метод" }
    OFF_BY { en: "Difference from least squares, over its u", ru: "Отличие от МНК, делённое на его\u{a0}u" }
    OFF_BY_NOTE {
        en: "Difference from least squares: in units of the standard uncertainty of that difference. The same input \
             errors act on both methods.",
        ru: "Отличие — разность с результатом метода наименьших квадратов (МНК) в единицах стандартной неопределённости \
             этой разности; на оба метода действуют одни и те же погрешности."
    }
    ANISOELASTICITY { en: "Anisoelastic coefficient", ru: "Коэффициент неравножёсткости" }
    SPECTRAL_RADIUS { en: "Spectral radius", ru: "Спектральный радиус" }
    STEPS { en: "Number of steps", ru: "Число шагов" }
    STEPS_PREDICTED { en: "Predicted number of steps", ru: "Ожидаемое число шагов" }
    STEPS_OVER { en: "more than {most}", ru: "более {most}" }
    REMAINDER_K { en: "Remaining error of K, at most", ru: "Остаточная погрешность K, не более" }
    REMAINDER_OMEGA {
        en: "Remaining error of the g-sensitive drifts, at most",
        ru: "Остаточная погрешность составляющих дрейфа, зависящих от g, не более"
    }
    NO_RESULT { en: "{method}: no result, because {why}.", ru: "{method}: результат не получен, так как {why}." }
    EIGHT_MISSING {
        en: "some of the eight positions that the method requires have no readings",
        ru: "показания имеются не для всех восьми положений, необходимых для метода"
    }
    SINGULAR { en: "the currents do not determine K", ru: "токи не определяют K" }
    DIVERGES {
        en: "the iteration does not converge (spectral radius {radius})",
        ru: "итерации не сходятся (спектральный радиус {radius})"
    }
    NOT_THIS_MODEL {
        en: "the method requires the model with ω_g and ω_k, a constant drift, and the same positions in every turn-on",
        ru: "метод применим только при модели с ω_g и ω_k, постоянном дрейфе и одинаковом наборе положений во всех \
             запусках"
    }
    CERTIFIED_BY { en: "Stand certified by", ru: "Сертификат стенда выдан" }
    CONVERGENCE_CAPTION {
        en: "Convergence: the larger of the two changes in each step, relative to its limit. The iteration stops when both \
             are below the limit; the first approximation counts as a step.",
        ru: "Сходимость: большее из двух изменений на каждом шаге, отнесённое к пределу. Итерации прекращаются, когда оба \
             меньше предела; первое приближение считается шагом."
    }

    CONFORMITY { en: "Comparison with gyro type {type}", ru: "Сравнение с типом {type}" }
    VERDICT_CAPTION {
        en: "Deviation from the nominal value; expanded uncertainty U (coverage factor k = {k}; coverage probability \
             95.45 %); ω_g and ω_k refer to the g of the type, g_0\u{a0}=\u{a0}{g} m/s²",
        ru: "Отклонение от номинального значения; расширенная неопределённость U (коэффициент охвата k = {k}; вероятность \
             охвата 95,45 %); ω_g и ω_k отнесены к g, заданному для типа, g_0\u{a0}=\u{a0}{g} м/с²"
    }
    STUDENT { en: "{k}, Student’s t", ru: "{k}, коэффициент Стьюдента" }
    CHANGE { en: "Change since the previous calibration", ru: "Изменение после предыдущей калибровки" }
    HISTORY { en: "Calibrations compared", ru: "Сопоставляемые калибровки" }
    HISTORY_MARKS { en: "; marks as in the comparison with the type", ru: "; отметки\u{a0}— как при сравнении с типом" }
    HISTORY_CAPTION {
        en: "Parameters of the earlier calibrations, in the order of their dates where stated, and of this one; expanded uncertainty U\u{a0}=\u{a0}2u \
             (coverage factor k = 2{marks}); ω_g and ω_k refer to {of}\u{a0}{g} m/s²",
        ru: "Параметры предыдущих калибровок (по датам, если они указаны) и этой; расширенная неопределённость U\u{a0}=\u{a0}2u \
             (коэффициент охвата k = 2{marks}); ω_g и ω_k отнесены к {of}\u{a0}{g} м/с²"
    }
    OF_TYPE { en: "the g of the type, g_0\u{a0}=", ru: "g, заданному для типа, g_0\u{a0}=" }
    OF_PLACE { en: "local g,", ru: "местному g," }
    CALIBRATED { en: "Calibration", ru: "Калибровка" }
    CHANGE_CAPTION {
        en: "Change since the previous calibration, to which the tolerance applies as well; expanded uncertainty U \
             (coverage factor k = {k}; coverage probability 95.45 %); ω_g and ω_k refer to the g of the type, \
             g_0\u{a0}=\u{a0}{g} m/s²",
        ru: "Изменение после предыдущей калибровки (допуск относится и к нему); расширенная неопределённость U \
             (коэффициент охвата k = {k}; вероятность охвата 95,45 %); ω_g и ω_k отнесены к g, заданному для типа, \
             g_0\u{a0}=\u{a0}{g} м/с²"
    }
    PARAMETER { en: "Parameter", ru: "Параметр" }
    NOMINAL { en: "Nominal", ru: "Номин. значение" }
    PREVIOUS {
        en: "Previous calibration: {day}, passport {passport}, currents {sha256}. U also includes errors common to both, \
             which do not affect the change.",
        ru: "Предыдущая калибровка: {day}, паспорт {passport}, токи {sha256}. U включает и погрешности, общие для \
             обеих калибровок, хотя в изменение они не входят."
    }
    NO_DAY_BUT_CURRENTS { en: "{number}, SHA-256 {sha256}…", ru: "№\u{a0}{number}, SHA-256 токов {sha256}…" }
    NO_DAY { en: "date not stated", ru: "дата не указана" }
    SAME_GYRO_NOT_SHOWN {
        en: "Not confirmed by serial number to be the same gyro.",
        ru: "Не подтверждено, что это тот же гироскоп."
    }
    EARLIER { en: "Previous", ru: "Предыдущее" }
    FOUND { en: "Value", ru: "Значение" }
    CONVERSION_OF_G {
        en: "Part of the deviation that comes from converting local g to the g of the type: {parts}.",
        ru: "Часть отклонения, вызванная пересчётом от местного g к g типа: {parts}."
    }
    FROM_GRAVITY {
        en: "Contribution of local g (standard uncertainty {u}) to U: {parts}. To reduce it, measure g.",
        ru: "Вклад местного g (u = {u}) в U: {parts}. Вклад уменьшают, измерив g."
    }
    FROM_UNKNOWN_HEIGHT {
        en: "Contribution of local g to U: {parts}. The height is not stated, so g is that at 0 m; its standard uncertainty, {u}, is the \
             r.m.s. error of this assumption for heights from 0 to 4000 m. To reduce it, state the height or measure g.",
        ru: "Вклад местного g в U: {parts}. Высота не указана, g вычислено для 0 м с u = {u} (среднее квадратическое отличие при \
             высотах от 0 до 4000 м). Вклад уменьшают, указав высоту или измерив g."
    }
    FROM_GRAVITY_PART { en: "{gravity} for {parameter}", ru: "{gravity} для {parameter}" }
    FROM_TURN_ONS {
        en: "The turn-on noise contributes {u}, most of the standard uncertainty of ω_0x and ω_0y. To reduce this, take more \
             turn-ons.",
        ru: "Вклад шума от запуска к запуску, {u}, составляет большую часть стандартной неопределённости ω_0x и ω_0y. Для \
             его уменьшения следует увеличить число запусков."
    }
    DEVIATION { en: "Deviation", ru: "Отклонение" }
    CHANGED_BY { en: "Change", ru: "Изменение" }
    TOLERANCE { en: "Tolerance", ru: "Допуск" }
    IN_UNIT_OF_PARAMETER { en: "In the unit of the parameter", ru: "В единицах параметра" }
    IN_UNIT_OF_TOLERANCE { en: "In the unit of the tolerance", ru: "В единицах допуска" }
    RISK { en: "Risk of\u{a0}error", ru: "Риск ошибки" }
    GUARDED { en: "Guarded acceptance", ru: "С защитной полосой" }
    PASSED_BY_SIMPLE {
        en: "By simple acceptance, without a guard band, {passed} of {all} parameters pass",
        ru: "Простая приёмка, без защитной полосы: соответствие допускам у {passed} из {all} параметров"
    }
    TOO_UNCERTAIN {
        en: "No value of {names} can pass by guarded acceptance: U exceeds the tolerance.",
        ru: "При любом значении {names} приёмка с защитной полосой невозможна: U больше допуска."
    }
    OPPOSITE {
        en: "With the other sign these would be within the tolerance: {names}. Check the sign convention.",
        ru: "С противоположным знаком в допуске были бы: {names}. Следует проверить правило знаков."
    }
    DEPENDENT {
        en: "No decision is made on {names}: it depends on a reading that is probably wrong.",
        ru: "Решение не принято для {names}: оно зависит от показания, которое, вероятно, ошибочно."
    }
    NO_RISK {
        en: "U exceeds every tolerance, so no risk of error is given (–).",
        ru: "U больше всех допусков, поэтому риск ошибки не приводится (–)."
    }
    RISK_NOTE {
        en: "Risk of error (specific risk): probability that the decision by simple acceptance is wrong.",
        ru: "Риск ошибки: вероятность того, что решение при простой приёмке неверно."
    }

    FIT { en: "Goodness of fit", ru: "Согласие показаний с моделью" }
    CHI_SQUARE { en: "Chi-square", ru: "Хи-квадрат" }
    FREEDOM { en: "Degrees of freedom", ru: "Число степеней свободы" }
    PROBABILITY { en: "Probability of a larger value", ru: "Вероятность большего значения" }
    CONSISTENT { en: "consistent: {limit} or more", ru: "согласуются: {limit} и более" }
    NOT_JUDGED {
        en: "The fit cannot be tested: there are as many unknowns as readings, so any readings would fit.",
        ru: "Согласие проверить нельзя: число неизвестных равно числу показаний, и модели соответствуют любые \
             показания."
    }
    TOO_SMALL {
        en: "Chi-square is much smaller than expected: the stated uncertainties are too large for these readings, or the \
             readings were computed, not measured.",
        ru: "Хи-квадрат значительно меньше ожидаемого: указанные неопределённости завышены либо показания получены расчётом."
    }
    TOO_SMALL_BY_TREND {
        en: "Chi-square is much smaller than expected: the trend enlarges the scatter of the visits, and so the uncertainties.",
        ru: "Хи-квадрат значительно меньше ожидаемого: изменение ω_0 увеличивает рассеяние между установками, а с ним и \
             неопределённости."
    }
    TOO_SMALL_OR_TURN_ONS {
        en: "Chi-square is much smaller than expected: the visits to all positions differ alike, as after another turn-on that \
             is not stated as such, and this enlarges the uncertainties; or the stated ones are too large.",
        ru: "Хи-квадрат значительно меньше ожидаемого: установки во все положения отличаются одинаково, как при новом запуске, \
             который не указан, и это увеличивает неопределённости; либо указанные завышены."
    }
    OF_UNCERTAINTIES {
        en: "Degrees of freedom of the input uncertainties (taken into account)",
        ru: "Число степеней свободы исходных неопределённостей (учтено)"
    }
    OF_ESTIMATES {
        en: "Some of the uncertainties have finite degrees of freedom, which the probability takes into account.",
        ru: "Часть неопределённостей известна с конечным числом степеней свободы; это учтено в вероятности."
    }
    SCATTER {
        en: "Scatter of the visits to a position, chi-square",
        ru: "Рассеяние между установками в положение, хи-квадрат"
    }
    ROW_SCATTER {
        en: "Scatter of the readings of a visit, chi-square",
        ru: "Рассеяние показаний в пределах одной установки в положение, хи-квадрат"
    }
    ROW_DEVIATION {
        en: "Standard deviation of a reading within a visit",
        ru: "Стандартное отклонение показания в пределах одной установки в положение"
    }
    ROWS_CORRELATED {
        en: "Successive readings of a visit are correlated ({r}), so their mean is less certain than their scatter shows, \
             and the stated uncertainties are too small. Average the readings of each visit into one row.",
        ru: "Последовательные показания одной установки в положение коррелированы ({r}): их среднее менее точно, чем \
             следует из рассеяния, и указанные неопределённости занижены. Показания каждой установки в положение следует \
             заменить их средним."
    }
    TURN_ON_SCATTER {
        en: "Scatter of the turn-ons, chi-square",
        ru: "Рассеяние между запусками, хи-квадрат"
    }
    VISIT_NOISE { en: "Gyro noise from visit to visit", ru: "Шум гироскопа между установками в положение" }
    TURN_ON_NOISE { en: "Gyro noise from turn-on to turn-on", ru: "Шум гироскопа от запуска к запуску" }
    NOISE_STATED { en: "as the gyro type states", ru: "по данным типа гироскопа" }
    NOISE_ESTIMATED {
        en: "estimated, {known} degrees of freedom",
        ru: "оценка, число степеней свободы {known}"
    }
    SUSPECT_VISIT {
        en: "Visit {visit} to position {index} in turn-on {cycle} differs from the other visits by {jx} µA in x and {jy} µA \
             in y, more than chance explains (probability below 0.001). It is included in the result.",
        ru: "Установка {visit} в положение {index} в запуске {cycle} отличается от других установок на {jx} мкА по x и \
             {jy} мкА по y; случайностью это не объяснить (вероятность меньше 0,001). Она учтена в результате."
    }
    SUSPECT_ROW {
        en: "Row {row} of visit {visit} to position {index} in turn-on {cycle} differs from the other rows of the visit by \
             {jx} µA in x and {jy} µA in y, more than chance explains (probability below 0.001). It is included in \
             the result.",
        ru: "Показание {row} установки {visit} в положение {index} в запуске {cycle} отличается от других показаний этой \
             установки на {jx} мкА по x и {jy} мкА по y; случайностью это не объяснить (вероятность меньше 0,001). Оно \
             учтено в результате."
    }
    ONE_OF_SEVERAL {
        en: "Either this or another one named here is wrong; the readings do not tell which.",
        ru: "Ошибка здесь или в другом названном месте; по показаниям это не установить."
    }
    DRIFTS {
        en: "The residuals show a trend in ω_0, ({x}, {y}) °/h per hour ({p}), which is not fitted. Fit it with \
             {option}.",
        ru: "Остатки обнаруживают изменение ω_0 во времени: ({x}; {y}) °/ч² ({p}). Модель его не содержит. Следует учесть \
             его: {option}."
    }
    DRIFTS_IN_ORDER {
        en: "In the order of the rows the residuals show a trend in ω_0, ({x}, {y}) °/h per visit ({p}), which is not fitted \
             and enlarges u. To fit it, state the time of each reading as time_s, and use {option}.",
        ru: "В порядке строк остатки обнаруживают изменение ω_0 на ({x}; {y}) °/ч от установки к установке ({p}). Модель \
             его не содержит, и оно увеличивает u. Чтобы учесть его, следует указать время каждого показания; \
             затем {option}."
    }
    DRIFT_OR_NOISE {
        en: "A drift in time was not tested, because the repeated visits cannot tell it from the noise of the gyro.",
        ru: "Изменение дрейфа во времени не проверено: по повторным установкам в\u{a0}положение его нельзя отличить от шума гироскопа."
    }
    G_MATRIX { en: "Matrix of g-sensitive drift", ru: "Матрица дрейфа, зависящего от\u{a0}g" }
    MODEL_TEST {
        en: "Adequacy of ω_g and ω_k alone: F = {f} with {further} and {rest} degrees of freedom; probability of a larger value, {p}.",
        ru: "Проверка достаточности ω_g и ω_k: F = {f} при {further} и {rest} степенях свободы; вероятность большего значения {p}."
    }
    CYCLES { en: "Turn-ons", ru: "Запуски" }
    CYCLE { en: "Turn-on", ru: "Запуск" }
    DRIFT_X { en: "Drift in time about x", ru: "Изменение дрейфа во времени, ось x" }
    DRIFT_Y { en: "Drift in time about y", ru: "Изменение дрейфа во времени, ось y" }
    ENLARGED { en: "Factor applied to the variance", ru: "Коэффициент увеличения дисперсии" }
    NOISE_ADDED {
        en: "The scatter of the visits is larger than the stated uncertainties explain. The noise of the gyro was \
             estimated from it and is included in all uncertainties.",
        ru: "Рассеяние между установками в положение больше, чем объясняют указанные неопределённости. По нему оценён шум \
             гироскопа, который учтён во всех неопределённостях."
    }
    LAST_DIGIT {
        en: "The currents are recorded to {digit} mA. Rounding to this digit has a standard uncertainty of {u} mA, which \
             is larger than the stated floor of the meter and takes its place. To reduce it, record more digits.",
        ru: "Токи записаны с шагом {digit} мА. Стандартная неопределённость округления {u} мА больше указанной \
             постоянной части погрешности измерителя и принята вместо неё. Для её уменьшения следует записывать больше \
             знаков."
    }
    IDENTICAL_ROWS {
        en: "All readings of a visit are identical, so they show no scatter: they are copies, or the last digit is too \
             coarse. They count as one reading.",
        ru: "Все показания одной установки в положение одинаковы, рассеяние отсутствует: это копии, или шаг отсчёта \
             слишком велик. Они учтены как одно показание."
    }
    IDENTICAL_VISITS {
        en: "All visits to a position are identical, so they show no scatter: they are copies, or the last digit is too \
             coarse. They count as one visit.",
        ru: "Все установки в одно положение дали одинаковые показания, рассеяние отсутствует: это копии, или шаг отсчёта \
             слишком велик. Они учтены как одна установка."
    }
    LESS_THAN_STATED {
        en: "The variation is less than stated. Readings taken without leaving the position belong to one visit.",
        ru: "Рассеяние меньше указанного. Показания, снятые без выхода из положения, относятся к одной установке."
    }
    RESIDUALS_CAPTION {
        en: "Residuals of the equations and their standard uncertainties",
        ru: "Остатки уравнений и их стандартные неопределённости"
    }
    HINT_EXCHANGED {
        en: "The readings of positions {one} and {other} may be exchanged.",
        ru: "Возможно, показания в положениях {one} и {other} переставлены."
    }
    HINT_SIGN {
        en: "The sign of {current} in position {index} may be reversed.",
        ru: "Возможно, в положении {index} знак тока {current} изменён на обратный."
    }
    HINT_EXCHANGED_CURRENTS {
        en: "The currents J_x and J_y of position {index} may be exchanged.",
        ru: "Возможно, в положении {index} переставлены токи J_x и J_y."
    }
    HINT_RENUMBERED {
        en: "The positions may be numbered in another way (readings → passport): {numbers}.",
        ru: "Возможно, положения пронумерованы иначе (показания → паспорт): {numbers}."
    }
    HINT_OTHER_AXIS {
        en: "The axis of the frame may point to an azimuth of about {azimuth}°, not to that of the passport.",
        ru: "Возможно, ось рамки стенда направлена по азимуту около {azimuth}°, а не по указанному в паспорте."
    }
    HINT_OTHER_MODEL {
        en: "The gyro may have g-sensitive drifts that the paper’s model does not describe; the general model fits the readings.",
        ru: "Возможно, дрейф гироскопа, зависящий от\u{a0}g, не описывается моделью статьи; общая модель с показаниями согласуется."
    }
    HINT_OTHER_STAND {
        en: "The passport may be that of another stand.",
        ru: "Возможно, паспорт относится к другому стенду."
    }
    HINT_DID_NOT_REPEAT {
        en: "Position {index} may not have been reproduced: if its angle has changed, the difference is {angle}″; if the currents \
             are wrong, their errors are {jx} µA in x and {jy} µA in y.",
        ru: "Возможно, положение {index} не воспроизведено: если изменился угол, отличие равно {angle}″; если неверны токи, \
             их погрешность {jx} мкА по x и {jy} мкА по y."
    }
    HINT_NOTHING {
        en: "No single position, no exchange or other numbering of positions and no other azimuth of the frame’s axis \
             explains this. The passport may be that of another stand (all positions differ by about {size}″), or the \
             gyro may have drifted, or the stand may have moved, during the run, or the stated uncertainties of the meter are \
             too small.",
        ru: "Этого не объясняют ни отклонение одного положения, ни перестановка или иная нумерация положений, ни \
             иной азимут оси рамки. Возможные причины: паспорт относится к другому стенду (все положения \
             отличаются примерно на {size}″), дрейф гироскопа или смещение стенда во время измерений, заниженная \
             неопределённость измерителя тока."
    }

    BLIND { en: "Errors that the residuals do not show", ru: "Погрешности, не выявляемые по остаткам" }
    CANNOT_TELL {
        en: "Small residuals do not exclude all errors. The following leave no residuals but change the result: the \
             passport of another site (latitude), a base tilted about east, a gyro rotated in its seat about the spin \
             axis, errors of the gain and offset of the meter, x and y exchanged, or the sign of one current reversed. A base rotated in azimuth \
             leaves almost no residuals. To detect these errors, check the serial number of the stand, the site of the \
             passport, the specification of the gyro and its previous calibration.",
        ru: "Малые остатки не исключают погрешностей и ошибок. Не проявляются в остатках, но изменяют результат: паспорт \
             для другого места установки (широта), наклон основания вокруг направления на восток, поворот гироскопа на \
             посадочной поверхности вокруг оси собственного вращения, погрешности коэффициента преобразования и смещения \
             нуля измерителя, перестановка x и y, обратный знак одного из токов. Поворот основания по азимуту почти не \
             проявляется в остатках. Для выявления таких погрешностей и ошибок проверяют заводской номер стенда, место \
             установки по паспорту, технические условия на гироскоп и результаты его предыдущей калибровки."
    }
    NOT_STATED {
        en: "u not stated, or stated as 0, and not included in any uncertainty:",
        ru: "u не указана (или равна 0) и не учтена в неопределённости:"
    }
    ALL_STATED {
        en: "The uncertainties of all relevant inputs are stated.",
        ru: "Неопределённости всех влияющих величин указаны."
    }
    NOT_STATED_PLATFORM { en: "common part of the platform", ru: "общая составляющая платформы" }
    NOT_STATED_BASE { en: "common part of the base of the stand", ru: "общая составляющая основания стенда" }
    NOT_STATED_GAIN { en: "gain of the meter", ru: "коэффициент преобразования измерителя" }
    NOT_STATED_OFFSET { en: "offset of the meter", ru: "смещение нуля измерителя" }
    NOT_STATED_SOME_ANGLES { en: "some of the certified angles", ru: "часть отклонений по сертификату" }
    NOT_STATED_VISITS { en: "gyro noise from visit to visit", ru: "шум гироскопа между установками" }
    NOT_STATED_TURN_ONS { en: "gyro noise from turn-on to turn-on", ru: "шум гироскопа от запуска к запуску" }
    NOT_STATED_GRAVITY { en: "gravity", ru: "местное ускорение g" }
    NOT_STATED_LEVEL { en: "level of the base", ru: "наклон основания" }
    NOT_STATED_SEAT { en: "gyro seat", ru: "угол посадки гироскопа" }

    BUDGET { en: "Uncertainty budget", ru: "Бюджет неопределённости" }
    BUDGET_CAPTION {
        en: "Contributions of the inputs, by kind, to the standard uncertainty of each parameter; ω_g and ω_k refer to \
             local g",
        ru: "Вклады входных величин (по видам) в стандартную неопределённость каждого параметра; ω_g и ω_k отнесены к \
             местному g"
    }
    SHARES_CAPTION {
        en: "Standard uncertainty u of each parameter, and the shares of its variance u²; ω_g and ω_k refer to local g",
        ru: "Стандартная неопределённость u каждого параметра и доли источников в его дисперсии u²; ω_g и ω_k отнесены к \
             местному g"
    }
    SHARES_CAPTION_AT_TYPE {
        en: "Standard uncertainty u of each parameter, and the shares of its variance u²; ω_g and ω_k refer to g_0",
        ru: "Стандартная неопределённость u каждого параметра и доли источников в его дисперсии u²; ω_g и ω_k отнесены к \
             g_0"
    }
    SHARE_OF_GRAVITY { en: "local g", ru: "местное g" }
    SHARES { en: "Share of the variance, %", ru: "Доля дисперсии, %" }
    OTHER_INPUTS { en: "other inputs", ru: "прочие входные величины" }
    BUDGET_DASH {
        en: "–: no contribution, or one that rounds to zero.",
        ru: "–: вклад отсутствует или при округлении равен нулю."
    }
    BUDGET_MEANS {
        en: "The u of repeatability, noise and visits is that of the mean of all visits to a position.",
        ru: "Для повторяемости, шума и установок в положение u относится к среднему по всем установкам в положение."
    }
    BUDGET_NOT_SHOWN {
        en: "Not shown, below a thousandth of every variance: {names}.",
        ru: "Не показаны величины, доля которых в каждой дисперсии менее тысячной: {names}."
    }
    BUDGET_WORST {
        en: "Largest uncertainty relative to tolerance: {parameter}, u = {u}.",
        ru: "Наибольшая неопределённость относительно допуска: {parameter}, u = {u}."
    }
    BUDGET_WORST_BUT_GRAVITY {
        en: "Largest uncertainty relative to tolerance, excluding local g: {parameter}, u = {u}.",
        ru: "Наибольшая неопределённость относительно допуска без учёта местного g: {parameter}, u = {u}."
    }
    BUDGET_WORST_OF_SIZE {
        en: "Largest uncertainty relative to the value: {parameter}, u = {u}.",
        ru: "Наибольшая неопределённость относительно значения: {parameter}, u = {u}."
    }
    BUDGET_NEARLY_ALL {
        en: "One source contributes nearly all of its variance ({share} %): {source}.",
        ru: "Почти всю дисперсию ({share} %) даёт один источник: {source}."
    }
    BUDGET_MOST {
        en: "One source contributes {share} % of its variance: {source}.",
        ru: "Один источник даёт {share} % дисперсии: {source}."
    }
    BUDGET_LARGEST {
        en: "The source with the largest share of its variance ({share} %): {source}.",
        ru: "Источник с наибольшей долей дисперсии ({share} %): {source}."
    }
    BUDGET_HALVES {
        en: "To halve u, reduce the uncertainty of this source to {limit} or less.",
        ru: "Для уменьшения u вдвое неопределённость этого источника не должна превышать {limit}."
    }
    BUDGET_LEAVES { en: "Without this source, u would be {rest}.", ru: "Без этого источника u составила бы {rest}." }
    COMBINED { en: "Combined u", ru: "Суммарная u" }
    BUDGET_GRAVITY { en: "Conversion to g_0", ru: "Пересчёт к g_0" }
    COMBINED_AT_G0 { en: "Combined u, for g_0", ru: "Суммарная u, для g_0" }
    EFFECTIVE_FREEDOM { en: "Effective degrees of freedom", ru: "Эффективное число степеней свободы" }
    INPUT { en: "{input}: u = {u}", ru: "{input}: u = {u}" }
    INPUTS { en: "{input}: u ≤ {u}", ru: "{input}: u ≤ {u}" }

    MONTE_CARLO { en: "Monte Carlo method", ru: "Метод Монте-Карло" }
    MONTE_CARLO_CAPTION {
        en: "{trials} trials, seed {seed}; probabilistically symmetric coverage intervals of coverage probability 95 % (that of U: \
             95.45 %); ω_g and ω_k refer to local g",
        ru: "Число испытаний {trials}, начальное значение генератора {seed}; вероятностно симметричные интервалы охвата для \
             вероятности 95 % (для U — 95,45 %); ω_g и ω_k отнесены к местному g"
    }
    MEAN { en: "Mean", ru: "Среднее" }
    LOWER { en: "Lower end", ru: "Нижняя граница" }
    UPPER { en: "Upper end", ru: "Верхняя граница" }
    FIRST_ORDER { en: "Linear approximation valid", ru: "Линейное приближение применимо" }
    NOT_LINEAR {
        en: "The linear approximation behind U is not valid for {names} (JCGM 101, 8): U and decisions by U are \
             unreliable. The coverage intervals of the Monte Carlo method (95\u{a0}%, at the local g) are reliable.",
        ru: "Линейное приближение, по которому вычислена U, неприменимо для {names} (JCGM 101, 8): U и решения по ней \
             недостоверны. Достоверны интервалы охвата по методу Монте-Карло (95\u{a0}%, при местном g)."
    }
    FIRST_ORDER_UNDECIDED {
        en: "◐: undecided; this needs more trials.",
        ru: "◐: не определено, требуется большее число испытаний."
    }
    NOT_STABLE {
        en: "Not all stated digits are stable; more trials would change some of them.",
        ru: "Не все приведённые цифры стабильны; при большем числе испытаний некоторые могут измениться."
    }

    ONLY_THIS_ONE {
        en: "The results relate only to the gyro identified here. This report shall not be reproduced except in full \
             without the written approval of the laboratory.",
        ru: "Результаты относятся только к указанному здесь гироскопу. Частичное воспроизведение отчёта без \
             письменного согласия лаборатории не допускается."
    }
    SIGNATURES { en: "Signatures", ru: "Подписи" }
    CALIBRATED_BY { en: "Calibrated by", ru: "Калибровку выполнил" }
    APPROVED_BY { en: "Approved by", ru: "Утвердил" }
    VALID_WHEN_SIGNED {
        en: "Valid only with a handwritten signature.",
        ru: "Документ действителен только с собственноручной подписью."
    }

    ANNEX { en: "Annex: machine-readable result", ru: "Приложение: машиночитаемый результат" }
    ANNEX_NOTE {
        en: "The result as computed by the program, with all digits. A later calibration can be compared with this \
             file.",
        ru: "Результат вычислений со всеми цифрами. С этим файлом можно сравнить последующую калибровку."
    }
    SAVE { en: "Save the result", ru: "Сохранить результат" }
}
