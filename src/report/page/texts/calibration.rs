//! The report of a calibration.

use super::texts;

texts! {
    TITLE { en: "Calibration of a dynamically tuned gyro", ru: "Калибровка динамически настраиваемого гироскопа" }
    SUBTITLE {
        en: "Scale factors and drifts in the case's axes, found from the torquer currents in the positions of a certified stand",
        ru: "Масштабные коэффициенты и составляющие дрейфа в осях корпуса, найденные по токам датчиков момента в положениях \
             аттестованного стенда"
    }
    MARGIN { en: "Calibration with passport {id}", ru: "Калибровка по паспорту {id}" }
    MARGIN_SHA256 { en: "SHA-256 of the currents {sha256}", ru: "SHA-256 файла токов {sha256}" }
    END { en: "End of the calibration report, passport {id}", ru: "Конец отчёта о калибровке, паспорт {id}" }

    NOT_VERIFIED { en: "Passport NOT VERIFIED", ru: "Паспорт НЕ ПРОВЕРЕН" }
    NOT_VERIFIED_WORDS {
        en: "Nobody checked who wrote the passport: anybody may have written its numbers. What stands below counts for nothing \
             until the passport has been verified.",
        ru: "Кем составлен паспорт, не проверялось: его числа мог записать кто угодно. Всё, что приведено ниже, не имеет силы, \
             пока паспорт не проверен."
    }
    DOES_NOT_FIT { en: "The readings do not fit this stand", ru: "Показания не согласуются с этим стендом" }
    DOES_NOT_FIT_WORDS {
        en: "Until that is explained, the parameters mean nothing.",
        ru: "Пока это не объяснено, найденные параметры не имеют смысла."
    }
    CONFORMS { en: "Within the tolerance of the type {type}", ru: "Соответствует допускам типа {type}" }
    CONFORMS_NOT { en: "NOT within the tolerance of the type {type}", ru: "НЕ соответствует допускам типа {type}" }
    UNDECIDED { en: "Not decided: conformity to the type {type}", ru: "Не решено: соответствие типу {type}" }
    RULE {
        en: "Guarded acceptance, with an expanded uncertainty U = 2u for a guard band (JCGM 106, 8.3).",
        ru: "Решение с защитной полосой, равной расширенной неопределённости U = 2u (JCGM 106, 8.3)."
    }
    NO_TYPE { en: "Parameters found", ru: "Параметры найдены" }
    NO_TYPE_WORDS {
        en: "No type of gyro was named: nothing is said of conformity.",
        ru: "Тип гироскопа не указан: о соответствии ничего не утверждается."
    }
    MISTAKE { en: "These are not the parameters of this gyro", ru: "Это не параметры данного гироскопа" }
    MISTAKE_CURRENTS {
        en: "The readings fit, but the parameters are not those of this gyro. One mistake explains it: {causes}. Check the cables of \
             the torquers, the signs and the unit of the currents, and calibrate again.",
        ru: "Показания согласуются, но параметры не соответствуют данному гироскопу. Это объясняется одной ошибкой: {causes}. Следует \
             проверить кабели датчиков момента, знаки и единицу токов и повторить калибровку."
    }
    MISTAKE_PLACE {
        en: "The readings fit, but the parameters are not those of this gyro. One mistake explains it: the passport is for another \
             place, and the stand is at a latitude of about {latitude}°. Check where the stand is, and calibrate again with the \
             passport for that place.",
        ru: "Показания согласуются, но параметры не соответствуют данному гироскопу. Это объясняется одной ошибкой: паспорт выдан для \
             другого места, а стенд находится на широте около {latitude}°. Следует проверить место установки стенда и повторить \
             калибровку по паспорту для этого места."
    }
    MISTAKE_AND { en: "and", ru: "и" }
    MISTAKE_EXCHANGED { en: "the columns of x and y are exchanged", ru: "столбцы x и y переставлены" }
    MISTAKE_X_REVERSED { en: "the sign of the column of x is reversed", ru: "знак столбца x изменён" }
    MISTAKE_Y_REVERSED { en: "the sign of the column of y is reversed", ru: "знак столбца y изменён" }
    MISTAKE_REVERSED { en: "the signs of both columns are reversed", ru: "знаки обоих столбцов изменены" }
    MISTAKE_MICROAMPERES {
        en: "the currents are in microamperes instead of milliamperes",
        ru: "токи указаны в микроамперах, а не в миллиамперах"
    }
    MISTAKE_TOO_LARGE { en: "every current is {factor} times too large", ru: "все токи завышены в {factor} раз" }
    MISTAKE_TOO_SMALL { en: "every current is {factor} times too small", ru: "все токи занижены в {factor} раз" }

    SUBJECT { en: "What was calibrated, where, and with what", ru: "Что, где и по чему калибровалось" }
    TYPE { en: "Type", ru: "Тип" }
    SERIAL { en: "Serial number of the gyro", ru: "Заводской номер гироскопа" }
    CUSTOMER { en: "Customer", ru: "Заказчик" }
    CONDITION { en: "Condition of the gyro", ru: "Состояние гироскопа" }
    RECEIVED { en: "Gyro received", ru: "Дата поступления" }
    MEASURED { en: "Date of the readings", ru: "Дата измерений" }
    REPORT_NUMBER { en: "Number of this report", ru: "Номер отчёта" }
    PROCEDURE { en: "Procedure, departures from it", ru: "Методика и отступления от неё" }
    STAND { en: "Stand", ru: "Стенд" }
    SITE { en: "Site", ru: "Место" }
    TIME { en: "As of", ru: "По состоянию на" }
    CURRENTS { en: "File of the currents", ru: "Файл токов" }
    CURRENTS_SHA256 { en: "SHA-256 of the currents", ru: "SHA-256 файла токов" }
    PASSPORT { en: "The stand's passport", ru: "Паспорт стенда" }
    PASSPORT_SHA256 { en: "SHA-256 of the passport", ru: "SHA-256 паспорта" }
    LABORATORY { en: "The laboratory", ru: "Лаборатория" }
    LABORATORY_NAME { en: "Laboratory", ru: "Лаборатория" }
    METER_ASSUMED {
        en: "No laboratory stated its meter: one of ±0.015 % of a reading, uniformly distributed, is assumed, and nothing else.",
        ru: "Лаборатория не указала свой измеритель: принят измеритель с погрешностью ±0,015 % показания, распределённой \
             равномерно, и ничего более."
    }
    TEMPERATURE { en: "Temperature", ru: "Температура" }
    TEMPERATURE_OUTSIDE {
        en: "The laboratory is at {here} °C; the deviations of the stand are certified for {low} to {high} °C.",
        ru: "В лаборатории {here} °C; отклонения стенда аттестованы для {low}–{high} °C."
    }
    GRAVITY { en: "Local gravity, the g of the drifts", ru: "Местное ускорение свободного падения, g составляющих дрейфа" }

    PARAMETERS { en: "Parameters", ru: "Параметры" }
    PARAMETERS_CAPTION {
        en: "Values, and beneath each its standard uncertainty u (k = 1); drifts per local g",
        ru: "Значения и под ними стандартная неопределённость u (k = 1); составляющие дрейфа отнесены к местному g"
    }
    LEAST_SQUARES { en: "least squares: the answer", ru: "метод наименьших квадратов: ответ" }
    LEAST_SQUARES_NAME { en: "least squares", ru: "метод наименьших квадратов" }
    ANALYTIC { en: "analytic method", ru: "аналитический метод" }
    ITERATIVE { en: "successive approximation", ru: "последовательные приближения" }
    OFF_BY { en: "off by, in its own u", ru: "отличие в его собственных u" }
    OFF_BY_NOTE {
        en: "Off by: the difference from least squares in units of that difference's own standard uncertainty; both methods see \
             the same errors.",
        ru: "Отличие: разность с методом наименьших квадратов в единицах её собственной стандартной неопределённости; на оба \
             метода действуют одни и те же погрешности."
    }
    ANISOELASTICITY { en: "Anisoelastic coefficient", ru: "Коэффициент неравножёсткости" }
    ITERATION { en: "Successive approximation", ru: "Последовательные приближения" }
    SPECTRAL_RADIUS { en: "Spectral radius", ru: "Спектральный радиус" }
    STEPS { en: "Steps taken", ru: "Выполнено шагов" }
    STEPS_PREDICTED { en: "Steps predicted", ru: "Предсказано шагов" }
    STEPS_OVER { en: "over {most}", ru: "более {most}" }
    REMAINDER_K { en: "Still missing in K, at most", ru: "Недостаёт в K, не более" }
    REMAINDER_OMEGA { en: "Still missing in the drifts per g, at most", ru: "Недостаёт в составляющих от g, не более" }
    NO_RESULT { en: "No result by this method: {method}.", ru: "Этим методом результата нет: {method}." }
    CONVERGENCE_CAPTION {
        en: "Convergence: the change that each step made, over the limit below which it stops",
        ru: "Сходимость: изменение на каждом шаге, отнесённое к пределу, ниже которого процесс останавливается"
    }

    CONFORMITY { en: "Against the type {type}", ru: "Сравнение с типом {type}" }
    VERDICT_CAPTION {
        en: "Deviation from the nominal value with expanded uncertainty U = 2u; values of the drifts at the type's g",
        ru: "Отклонение от номинального значения с расширенной неопределённостью U = 2u; значения составляющих дрейфа при g типа"
    }
    CHANGE { en: "Change since the earlier calibration", ru: "Изменение с прежней калибровки" }
    CHANGE_CAPTION {
        en: "Change with expanded uncertainty U = 2u, against the same tolerance, which is one of instability; values of the drifts at \
             the type's g",
        ru: "Изменение с расширенной неопределённостью U = 2u в сравнении с тем же допуском, то есть с нестабильностью; значения \
             составляющих дрейфа при g типа"
    }
    PARAMETER { en: "Parameter", ru: "Параметр" }
    UNIT { en: "Unit", ru: "Единица" }
    NOMINAL { en: "Nominal", ru: "Номинальное значение" }
    EARLIER { en: "Earlier", ru: "Прежнее значение" }
    FOUND { en: "Found", ru: "Найденное значение" }
    FROM_GRAVITY {
        en: "Of U, {gravity} in {parameter} comes from the local g, whose uncertainty is {u}. Gravity measured, or the height of the \
             site in its file, makes it smaller.",
        ru: "Из U для {parameter} на местное g, неопределённость которого {u}, приходится {gravity}. Измеренное ускорение свободного \
             падения или высота места в его файле уменьшат эту составляющую."
    }
    DEVIATION { en: "Deviation", ru: "Отклонение" }
    CHANGED_BY { en: "Change", ru: "Изменение" }
    TOLERANCE { en: "Tolerance", ru: "Допуск" }
    EXPANDED_SHORT { en: "U", ru: "U" }
    SIMPLE { en: "Simple", ru: "Без полосы" }
    GUARDED { en: "Guarded", ru: "С полосой" }
    RISK { en: "Risk", ru: "Риск" }
    RISK_NOTE {
        en: "Simple: without a guard band. Guarded: what cannot be decided with this uncertainty is undecided. Risk: probability \
             that the simple decision is wrong.",
        ru: "Без полосы: решение без учёта неопределённости. С полосой: чего нельзя решить при этой неопределённости, то не \
             определено. Риск: вероятность того, что решение без полосы ошибочно."
    }
    BELOW { en: "< {limit}", ru: "< {limit}" }
    TOLERANCES { en: "Parameters against their tolerance", ru: "Параметры в сравнении с допусками" }
    TOLERANCES_CAPTION { en: "Each deviation as a share of its tolerance", ru: "Отклонения в долях допуска" }
    CHANGES_CAPTION { en: "Changes against the tolerance", ru: "Изменения в сравнении с допусками" }

    FIT { en: "The fit", ru: "Согласие показаний" }
    CHI_SQUARE { en: "Chi-square", ru: "Хи-квадрат" }
    FREEDOM { en: "Degrees of freedom", ru: "Число степеней свободы" }
    PROBABILITY { en: "Probability of a larger value", ru: "Вероятность большего значения" }
    NOT_JUDGED {
        en: "The fit cannot be judged: there are as many unknowns as readings, so any readings would fit.",
        ru: "Согласие оценить нельзя: число неизвестных равно числу показаний, и им соответствуют любые показания."
    }
    OF_UNCERTAINTIES {
        en: "Degrees of freedom of the uncertainties, taken into account",
        ru: "Число степеней свободы неопределённостей, учтено"
    }
    SCATTER { en: "Scatter of the visits of a position, chi-square", ru: "Рассеяние установок в положение, хи-квадрат" }
    ROW_SCATTER { en: "Scatter of the readings of a visit, chi-square", ru: "Рассеяние показаний одной установки, хи-квадрат" }
    ROW_DEVIATION {
        en: "Standard deviation of a reading within a visit",
        ru: "Стандартное отклонение показания в одной установке"
    }
    ENLARGED { en: "Variance enlarged, times", ru: "Дисперсия увеличена, раз" }
    LESS_THAN_STATED {
        en: "This is less scatter than stated. Readings taken without leaving the position belong to one visit.",
        ru: "Рассеяние меньше указанного. Показания, снятые без ухода из положения, — одна установка."
    }
    RESIDUALS_CAPTION {
        en: "Residuals of the equations with their standard uncertainty",
        ru: "Остатки уравнений и их стандартная неопределённость"
    }
    RESIDUALS_FIGURE { en: "Residuals within their limits", ru: "Остатки и их границы" }
    HINT { en: "What may be wrong", ru: "В чём может быть причина" }
    HINT_EXCHANGED {
        en: "The readings of positions {one} and {other} may be exchanged.",
        ru: "Возможно, показания в положениях {one} и {other} переставлены."
    }
    HINT_DID_NOT_REPEAT {
        en: "Position {index} may not have repeated: by {angle}″ if it was the angle, by {jx} µA along x and {jy} µA along y if it \
             was the currents.",
        ru: "Возможно, положение {index} не повторилось: на {angle}″, если дело в угле, на {jx} мкА по x и {jy} мкА по y, если дело \
             в токах."
    }
    HINT_NOTHING {
        en: "No single position and no exchange of two explains it: is it the passport of another stand? (All positions are out by \
             some {size}″.) Or did the gyro drift, or the stand move, during the run?",
        ru: "Ни одно положение и ни одна перестановка двух этого не объясняют: не от другого ли стенда паспорт? (Все положения \
             отличаются примерно на {size}″.) Или гироскоп дрейфовал либо стенд сместился во время измерений?"
    }

    BLIND { en: "What the fit cannot see", ru: "Чего согласие не показывает" }
    CANNOT_TELL {
        en: "A good fit proves less than it seems. These leave no residuals at all, and change the result: the passport of another \
             place (latitude), a base tilted about east, a gyro turned in its seat about the spin axis, the meter's gain and \
             offset, x and y exchanged, one sign reversed; a base turned in azimuth leaves almost none. What can tell: the serial \
             number of the stand and the place of the passport, the specification of the gyro, and its earlier calibration.",
        ru: "Хорошее согласие доказывает меньше, чем кажется. Совсем не оставляют остатков, но меняют результат: паспорт для другого \
             места (широта), наклон основания вокруг направления на восток, поворот гироскопа на платформе вокруг оси собственного \
             вращения, погрешности усиления и нуля измерителя, перестановка x и y, ошибка одного знака; поворот основания по \
             азимуту почти не оставляет их. Выявить это могут: номер стенда и место паспорта, технические условия гироскопа и его \
             прежняя калибровка."
    }
    NOT_STATED {
        en: "Not stated by anybody, and so missing from every uncertainty:",
        ru: "Никем не указано и потому не вошло ни в одну неопределённость:"
    }
    ALL_STATED { en: "Every uncertainty that counts is stated.", ru: "Все учитываемые неопределённости указаны." }
    NOT_STATED_ANGLES { en: "the certified angles", ru: "аттестованные углы" }
    NOT_STATED_RETURN { en: "the return to a position", ru: "возвращение в положение" }
    NOT_STATED_PLATFORM { en: "the part shared on the platform", ru: "общая составляющая платформы" }
    NOT_STATED_BASE { en: "the part shared on the stand's base", ru: "общая составляющая основания стенда" }
    NOT_STATED_LATITUDE { en: "the latitude", ru: "широта" }
    NOT_STATED_DEFLECTION { en: "the deflection of the vertical", ru: "уклонение отвесной линии" }
    NOT_STATED_MARK { en: "the azimuth of the mark", ru: "азимут ориентирного пункта" }
    NOT_STATED_GRAVITY { en: "gravity", ru: "ускорение свободного падения" }
    NOT_STATED_AZIMUTH { en: "the azimuth of the base", ru: "азимут основания" }
    NOT_STATED_LEVEL { en: "the level of the base", ru: "горизонтирование основания" }
    NOT_STATED_SEAT { en: "the gyro's seat", ru: "посадка гироскопа" }

    BUDGET { en: "Uncertainty budget", ru: "Бюджет неопределённости" }
    BUDGET_CAPTION {
        en: "What each kind of input contributes to the standard uncertainty of each parameter",
        ru: "Вклад каждого вида входных величин в стандартную неопределённость каждого параметра"
    }
    BUDGET_WORST {
        en: "Known least well for its tolerance is {parameter}: u = {u}.",
        ru: "Наименее точно по отношению к допуску известен параметр {parameter}: u = {u}."
    }
    BUDGET_WORST_OF_SIZE {
        en: "Known least well for its size is {parameter}: u = {u}.",
        ru: "Наименее точно по отношению к своему значению известен параметр {parameter}: u = {u}."
    }
    BUDGET_NEARLY_ALL {
        en: "Nearly all of its variance, {share} %, comes from one source: {source}.",
        ru: "Почти всю его дисперсию, {share} %, даёт один источник: {source}."
    }
    BUDGET_MOST {
        en: "Of its variance, {share} % come from one source: {source}.",
        ru: "{share} % его дисперсии даёт один источник: {source}."
    }
    BUDGET_LARGEST {
        en: "The largest part of its variance, {share} %, comes from one source: {source}.",
        ru: "Наибольшую часть его дисперсии, {share} %, даёт один источник: {source}."
    }
    BUDGET_HALVES {
        en: "To halve u, the uncertainty of that source has to be {limit} at most.",
        ru: "Чтобы u уменьшилась вдвое, неопределённость этого источника не должна превышать {limit}."
    }
    BUDGET_LEAVES { en: "Without it, u would still be {rest}.", ru: "Без него u всё ещё составляла бы {rest}." }
    COMBINED { en: "combined, u", ru: "суммарная, u" }
    EFFECTIVE_FREEDOM { en: "effective degrees of freedom", ru: "эффективное число степеней свободы" }
    EXPANDED { en: "expanded, U for 95\u{a0}%", ru: "расширенная, U для 95\u{a0}%" }
    INPUT { en: "{input}: u\u{a0}=\u{a0}{u}", ru: "{input}: u\u{a0}=\u{a0}{u}" }
    CAUSE_ANGLE { en: "certified angles", ru: "аттестованные углы" }
    CAUSE_RETURN { en: "returns to the positions", ru: "возвращения в положения" }
    CAUSE_READING { en: "meter, specification", ru: "измеритель, погрешность показания" }
    CAUSE_FLOOR { en: "meter, floor", ru: "измеритель, постоянная часть" }
    CAUSE_NOISE { en: "meter, noise", ru: "измеритель, шум показаний" }
    CAUSE_PLATFORM { en: "platform about {axis}", ru: "платформа вокруг {axis}" }
    CAUSE_SEAT { en: "seat about {axis}", ru: "посадка вокруг {axis}" }
    CAUSE_BASE { en: "stand's base about {axis}", ru: "основание стенда вокруг {axis}" }
    CAUSE_LEVEL { en: "level about {axis}", ru: "горизонт вокруг {axis}" }
    CAUSE_AZIMUTH { en: "azimuth of the base", ru: "азимут основания" }
    CAUSE_MARK { en: "azimuth of the mark", ru: "азимут ориентирного пункта" }
    CAUSE_LATITUDE { en: "latitude", ru: "широта" }
    CAUSE_DEFLECTION { en: "deflection of the vertical", ru: "уклонение отвесной линии" }
    CAUSE_GAIN { en: "meter, gain", ru: "измеритель, усиление" }
    CAUSE_OFFSET { en: "meter, offset", ru: "измеритель, смещение нуля" }

    MONTE_CARLO { en: "Monte Carlo", ru: "Метод Монте-Карло" }
    MONTE_CARLO_CAPTION {
        en: "{trials} trials, seed {seed}; symmetric intervals for 95 %",
        ru: "Испытаний: {trials}, начальное число {seed}; симметричные интервалы для 95 %"
    }
    MEAN { en: "mean", ru: "среднее" }
    LOWER { en: "lower end", ru: "нижняя граница" }
    UPPER { en: "upper end", ru: "верхняя граница" }
    FIRST_ORDER { en: "first order valid", ru: "первый порядок годится" }
    NOT_STABLE {
        en: "Not every stated digit is stable yet: more trials would move some.",
        ru: "Не все приведённые цифры установились: при большем числе испытаний некоторые изменятся."
    }

    ONLY_THIS_ONE {
        en: "The results relate only to the gyro named here. This report is to be reproduced in full only, unless the laboratory has \
             agreed in writing.",
        ru: "Результаты относятся только к указанному здесь гироскопу. Частичное воспроизведение отчёта без письменного согласия \
             лаборатории не допускается."
    }
    SIGNATURES { en: "Signatures", ru: "Подписи" }
    CALIBRATED_BY { en: "Calibrated by", ru: "Калибровку выполнил" }
    APPROVED_BY { en: "Approved by", ru: "Утвердил" }
    POST_AND_NAME { en: "Post and name", ru: "Должность, фамилия" }
    SIGNATURE { en: "Signature", ru: "Подпись" }
    DATE { en: "Date", ru: "Дата" }
    STAMP { en: "Stamp", ru: "М. П." }
    VALID_WHEN_SIGNED { en: "Counts only when signed by hand.", ru: "Действительно только с собственноручной подписью." }

    ANNEX { en: "Annex: the result for programs", ru: "Приложение: результат для программ" }
    ANNEX_NOTE {
        en: "What the program computed, every number in full. A later calibration compares itself with this file.",
        ru: "Вычисленное программой, все числа полностью. С этим файлом сравнивается последующая калибровка."
    }
    SAVE { en: "Save the result", ru: "Сохранить результат" }
}
