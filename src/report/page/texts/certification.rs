//! Texts of the record of a certification.

use super::texts;

texts! {
    TITLE { en: "Record of the certification of a test stand", ru: "Протокол калибровки поворотного стенда" }
    SUBTITLE {
        en: "Readings, tests and uncertainty behind a calibration certificate",
        ru: "Показания, критерии и неопределённость, на которых основан сертификат калибровки"
    }
    MARGIN { en: "Record of the certification, certificate {number}", ru: "Протокол к сертификату {number}" }
    MARGIN_SHA256 { en: "SHA-256 of the file of readings {sha256}", ru: "SHA-256 файла показаний {sha256}" }
    END { en: "End of the record of the certification, certificate {number}", ru: "Конец протокола к сертификату {number}" }

    SUBJECT { en: "Stand and certificate", ru: "Стенд и сертификат" }

    READINGS { en: "Readings", ru: "Показания" }
    FILE { en: "File of readings", ru: "Файл показаний" }
    FILE_SHA256 { en: "SHA-256 of the file", ru: "SHA-256 файла" }
    RUNS { en: "Runs", ru: "Серии" }
    POSITIONS { en: "Positions", ru: "Положения" }
    REPEATED { en: "Rows averaged with another row of the same visit", ru: "Строки, усреднённые с другими строками того же положения и серии" }
    EXCLUSIONS { en: "Excluded readings and runs", ru: "Исключённые показания и серии" }
    NO_EXCLUSIONS { en: "No reading was excluded.", ru: "Показания не исключались." }
    EXCLUSIONS_NOTE {
        en: "An excluded reading is predicted from all others by least squares, so it contributes neither to the means \
             nor to the scatter.",
        ru: "Исключённое показание заменено значением, рассчитанным по остальным методом наименьших квадратов; на средние и \
             оценки рассеяния оно не влияет."
    }
    POSITION { en: "Position", ru: "Положение" }
    RUN { en: "Run", ru: "Серия" }
    ALL_POSITIONS { en: "all", ru: "все" }
    REASON { en: "Reason", ru: "Причина" }

    RESULT { en: "Certified deviations", ru: "Отклонения положений" }
    WITH_OUTLIERS {
        en: "The means include readings that a test identified as outliers or stragglers: {readings}; see section “{section}”.",
        ru: "В средние вошли показания, отмеченные критерием как выбросы или квазивыбросы: {readings}; см. раздел «{section}»."
    }
    READING_OF { en: "position {index}, run {run}", ru: "положение {index}, серия {run}" }
    OF_A_VISIT {
        en: "standard deviation of a visit, pooled",
        ru: "стандартное отклонение одной установки в положение, объединённое"
    }
    COMMON_PARTS { en: "Common parts, per axis: platform; base", ru: "Общие составляющие: платформа; основание" }
    FEW { en: "few: see section\u{a0}{number}", ru: "мало: см. раздел\u{a0}{number}" }
    ZERO {
        en: "0: upper limit in section\u{a0}{number}",
        ru: "0: верхняя граница в разделе\u{a0}{number}"
    }
    STANDARD { en: "standard uncertainty (k = 1)", ru: "стандартная неопределённость (k = 1)" }

    UNCERTAINTY { en: "Uncertainty", ru: "Неопределённость" }
    BUDGET { en: "Budget of the certificate (k = 1)", ru: "Бюджет неопределённости сертификата (k = 1, по каждой оси)" }
    COMPONENTS { en: "Components found in the readings", ru: "Составляющие, найденные по показаниям" }
    COMPONENTS_NOTE {
        en: "A reading differs from the mean of its position by a rotation of the platform and one of the base, both \
             common to the whole run, and by the scatter of the single visit. s: standard deviation; ν: its degrees of \
             freedom; s/√R: its contribution to the mean of R runs. The repeatability is the quadratic mean of s over x, y and z, \
             weighted by ν. The upper limit is one-sided, by chi-square, with the scatter of the visits subtracted.",
        ru: "Показание отличается от среднего по положению на поворот платформы и поворот основания, общие для всей \
             серии, и на случайное отклонение одной установки в положение. s — стандартное отклонение, ν — число его \
             степеней свободы, s/√R — его вклад в среднее по R\u{a0}сериям. Повторяемость — среднее квадратическое s по \
             x, y и z с весами ν. Верхняя граница — односторонняя, по хи-квадрат, за вычетом рассеяния установок."
    }
    FEW_DEGREES {
        en: "Below ν = 4 the uncertainty of s itself exceeds 35 % (JCGM 100, E.4.3): see its upper limit.",
        ru: "При ν < 4 относительная неопределённость самого s более 35 % (JCGM 100, E.4.3): см. верхнюю границу s."
    }
    COMPONENT { en: "Component", ru: "Составляющая" }
    OWN_X { en: "Visit, about x", ru: "Установка в положение, вокруг x" }
    OWN_Y { en: "Visit, about y", ru: "Установка в положение, вокруг y" }
    OWN_Z { en: "Visit, about z", ru: "Установка в положение, вокруг z" }
    POOLED { en: "Visit, pooled (repeatability)", ru: "Установка в положение, по всем осям (повторяемость)" }
    PLATFORM { en: "Run, platform, per axis", ru: "Серия, платформа, на одну ось" }
    BASE { en: "Run, base, per axis", ru: "Серия, основание, на одну ось" }
    UPPER { en: "Upper limit of s (95 %), ″", ru: "Верхняя граница s (95 %), ″" }
    RUN_TURNS {
        en: "Rotation in each run relative to the mean, ″",
        ru: "Поворот платформы и основания в каждой серии относительно среднего, ″"
    }
    OF_PLATFORM { en: "Platform", ru: "Платформа" }
    OF_BASE { en: "Base", ru: "Основание" }

    TESTS { en: "Tests", ru: "Статистические критерии" }
    TEST { en: "Test", ru: "Критерий" }
    STATISTIC { en: "Value", ru: "Значение" }
    PROBABILITY { en: "Probability", ru: "Вероятность" }
    BARTLETT_POSITIONS { en: "Bartlett: equal variances of all positions, chi-square", ru: "Бартлетта: равенство дисперсий всех положений, хи-квадрат" }
    BARTLETT_AXES { en: "Bartlett: equal variances about x, y and z, chi-square", ru: "Бартлетта: равенство дисперсий вокруг x, y и z, хи-квадрат" }
    COCHRAN { en: "Cochran: position {index} scatters more, ratio", ru: "Кохрена: наибольшее рассеяние в положении {index}, отношение" }
    GRUBBS {
        en: "Grubbs: position {index}, run {run}, about {axis}, difference, ″",
        ru: "Граббса: положение {index}, серия {run}, вокруг {axis}, отличие, ″"
    }
    GRUBBS_PLATFORM {
        en: "Grubbs: run {run}, platform about {axis}, rotation, ″",
        ru: "Граббса: серия {run}, платформа вокруг {axis}, поворот, ″"
    }
    GRUBBS_BASE {
        en: "Grubbs: run {run}, base about {axis}, rotation, ″",
        ru: "Граббса: серия {run}, основание, ось «{axis}», поворот, ″"
    }
    MOVE_PLATFORM {
        en: "Student: shift after run {run}, platform about {axis}, rotation, ″",
        ru: "Стьюдента: смещение после серии {run}, платформа вокруг {axis}, поворот, ″"
    }
    MOVE_BASE {
        en: "Student: shift after run {run}, base about {axis}, rotation, ″",
        ru: "Стьюдента: смещение после серии {run}, основание, ось «{axis}», поворот, ″"
    }
    DRIFT_PLATFORM {
        en: "Student: drift, platform about {axis}, rotation from run to run, ″",
        ru: "Стьюдента: дрейф, платформа вокруг {axis}, поворот от серии к серии, ″"
    }
    DRIFT_BASE {
        en: "Student: drift, base about {axis}, rotation from run to run, ″",
        ru: "Стьюдента: дрейф, основание, ось «{axis}», поворот от серии к серии, ″"
    }
    OUTLYING_ANGLES {
        en: "Grubbs: most extreme angle of {count}, difference, ″",
        ru: "Граббса: самый сомнительный угол из {count}, отличие, ″"
    }
    ROTATED_RUNS {
        en: "Grubbs: most extreme run of {count} ({axes} axes), rotation, ″",
        ru: "Граббса: самая сомнительная серия из {count} (осей: {axes}), поворот, ″"
    }
    MOVE_OR_DRIFT {
        en: "Student: most extreme shift or drift of {count} runs, rotation, ″",
        ru: "Стьюдента: наибольшее смещение или дрейф (серий: {count}), поворот, ″"
    }
    NOT_SUSPECT { en: "not suspect", ru: "не выделяется" }
    EQUAL { en: "no difference found", ru: "различий не найдено" }
    DOUBTFUL { en: "doubtful", ru: "сомнительно" }
    UNEQUAL { en: "different", ru: "различие значимо" }
    NOT_MADE { en: "not run", ru: "не применялся" }
    OUTLIER { en: "outlier", ru: "выброс" }
    SIGNIFICANT { en: "significant", ru: "значимо" }
    PROBABLE { en: "suspected", ru: "возможно" }
    STRAGGLER { en: "straggler", ru: "квазивыброс" }
    TESTS_NOTE {
        en: "Value: the quantity named last in the first column; differences are relative to the other readings, rotations \
             to the other runs. ν: degrees of freedom. Probability of a result at least as extreme by chance: below 5 % \
             a value is a straggler, equality is doubtful, and a shift or drift is suspected; below 1 % a value is an \
             outlier, the variances differ significantly, and a shift or drift is significant. No reading is excluded \
             because of these tests. Bartlett’s test requires a fine resolution and no suspect reading.",
        ru: "Значение — величина в конце названия критерия; отличия — от остальных показаний, повороты — от остальных \
             серий. ν — число степеней свободы. Вероятность случайно получить не меньшее по модулю значение: менее 5 % — \
             квазивыброс, равенство сомнительно, возможны смещение или дрейф; менее 1 % — выброс, различие дисперсий, \
             смещение или дрейф значимы. По критериям показания не исключают. Критерий Бартлетта требует малого \
             шага отсчёта и отсутствия сомнительных показаний."
    }
    WARNINGS_COUNTED {
        en: "Warnings of the program: {count}; see section “{section}”.",
        ru: "Предупреждений программы: {count}; см. раздел «{section}»."
    }
    WARNINGS { en: "Warnings of the program", ru: "Предупреждения программы" }

    DRAFT { en: "Draft: this certificate was not issued", ru: "Проект: этот сертификат не выдан" }
    DRAFT_WORDS {
        en: "A dry run computed it. Neither a certificate nor a passport was written.",
        ru: "Данные сертификата вычислены в пробном режиме. Ни сертификат, ни паспорт не записаны."
    }
    CHANGE { en: "Change since the previous certificate", ru: "Изменение после предыдущей калибровки" }
    CERTIFIED {
        en: "Positions certified: {positions}; runs: {runs}",
        ru: "Откалибровано положений: {positions} (серий: {runs})"
    }
    NOT_COMPARED {
        en: "The readings were not compared with a previous certificate.",
        ru: "Показания не сравнивались с предыдущим сертификатом."
    }
    SAME {
        en: "The stand is unchanged since certificate {number}",
        ru: "Стенд не изменился после выдачи сертификата {number}"
    }
    CHANGED {
        en: "The stand has changed since certificate {number}",
        ru: "Стенд изменился после выдачи сертификата {number}"
    }
    UNDECIDED {
        en: "It is undecided whether the stand has changed since certificate {number}",
        ru: "Не установлено, изменился ли стенд после выдачи сертификата {number}"
    }
    CHANGED_WORDS {
        en: "The passports of that certificate no longer describe the stand: re-issue them from this one. Calibrations since the \
             change may be wrong.",
        ru: "Паспорта, выданные по тому сертификату, стенду больше не соответствуют: их следует перевыпустить по этому. \
             Калибровки, выполненные после изменения, могут быть неверны."
    }
    UNDECIDED_WORDS {
        en: "Measure the position again, or exclude the reading for a stated reason.",
        ru: "Следует повторить измерения в этом положении или исключить показание с указанием причины."
    }
    CHANGE_CAPTION {
        en: "Deviations of certificate {number} and of this one; u: standard uncertainty of the change",
        ru: "Отклонения по сертификату {number} и по новому; u — стандартная неопределённость изменения"
    }
    ROTATIONS {
        en: "Rotation in each position relative to the other positions",
        ru: "Поворот в каждом положении относительно остальных"
    }
    TWO_CHANGES {
        en: "The decision rests on the rotation of the platform relative to the other positions (u from the repeatability \
             of the previous certificate, if stated): changed if the probability, times the number of positions, is below \
             {limit}; undecided if outliers or scatter leave this open. Below are the changes of the deviations, computed \
             before rounding (u from their uncertainties in both certificates).",
        ru: "Решение принимается по повороту платформы относительно остальных положений (u — по повторяемости из предыдущего \
             сертификата, если указана): изменилось, если вероятность, умноженная на число положений, меньше {limit}; не \
             определено, если выбросы или рассеяние не позволяют решить. Ниже — изменения отклонений до округления (u — по \
             неопределённостям в обоих сертификатах)."
    }
    REPEATS { en: "unchanged", ru: "без изменений" }
    REPEATS_NOT { en: "changed", ru: "изменилось" }
    ANGLE { en: "Angle", ru: "Угол" }
    OLD { en: "Before", ru: "Предыдущее" }
    NEW { en: "Now", ru: "Новое" }
    DIFFERENCE_IN_U { en: "Change/u", ru: "Изменение/u" }
    ALL_TOGETHER { en: "All positions, F (ν)", ru: "Все положения, F (ν)" }
    COMMON_TURN { en: "Common rotation, F (ν)", ru: "Общий поворот, F (ν)" }

    MEASURED_BY { en: "Measured by", ru: "Измерения выполнил" }
    CHECKED_BY { en: "Checked by", ru: "Проверил" }

    ANNEX { en: "Annex: the file of readings", ru: "Приложение: файл показаний" }
    ANNEX_NOTE {
        en: "The file as it was read, verbatim. Its SHA-256 is in the certificate.",
        ru: "Файл воспроизведён дословно. Его хеш SHA-256 указан в сертификате."
    }
    SAVE { en: "Save the file of readings", ru: "Сохранить файл показаний" }
}
