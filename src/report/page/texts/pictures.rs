//! The words in pictures and of their descriptions.

use super::texts;

texts! {
    UPWARDS { en: "up", ru: "верх" }
    DOWNWARDS { en: "down", ru: "низ" }
    NORTH_LETTER { en: "N", ru: "С" }
    EAST_LETTER { en: "E", ru: "В" }
    SOUTH_LETTER { en: "S", ru: "Ю" }
    WEST_LETTER { en: "W", ru: "З" }
    UP { en: "up", ru: "верх" }

    POSITION_TITLE { en: "Position {index} of the stand", ru: "Положение {index} стенда" }
    POSITION_DESCRIPTION {
        en: "Frame angle θ = {theta}°, platform angle φ = {phi}°. Directions of the case's axes as certified: x {x} (within \
             {x_angle}°), y {y} (within {y_angle}°), z, the spin axis, {z} (within {z_angle}°).",
        ru: "Угол рамки θ = {theta}°, угол платформы φ = {phi}°. Направления осей корпуса по результатам аттестации: x — {x} \
             (в пределах {x_angle}°), y — {y} (в пределах {y_angle}°), z (ось собственного вращения) — {z} (в пределах \
             {z_angle}°)."
    }
    CASE_AXES { en: "axes x, y, z of the gyro's case, as certified", ru: "оси x, y, z корпуса гироскопа, аттестованные" }
    CASE_AXES_IDEAL { en: "the same as designed, where they differ visibly", ru: "те же оси, номинальные, где отличие заметно" }
    FRAME { en: "frame, turned by θ about east (ξ)", ru: "рамка, повёрнута на угол θ вокруг направления на восток (ξ)" }
    PLATFORM {
        en: "platform with the gyro, turned by φ about z; its two pins lie along x",
        ru: "платформа с гироскопом, повёрнута на угол φ вокруг z; два штифта лежат вдоль x"
    }
    BASE_AXES { en: "north (η) and up (ζ) of the base", ru: "север (η) и верх (ζ) основания" }

    DEVIATIONS_TITLE { en: "Certified deviations {angle} about {axis}", ru: "Аттестованные отклонения {angle} вокруг {axis}" }
    DEVIATION_IN_WORDS { en: "position {index}: {value}″", ru: "положение {index}: {value}″" }
    DEVIATION_WITH_U_IN_WORDS { en: "position {index}: {value}″, u = {u}″", ru: "положение {index}: {value}″, u = {u}″" }
    DEVIATION_BAR {
        en: "certified deviations α, β, γ about x, y, z of the platform",
        ru: "аттестованные отклонения α, β, γ вокруг осей x, y, z платформы"
    }
    DEVIATION_WHISKER {
        en: "±2u, with the position's own certified standard uncertainty u",
        ru: "±2u, где u — аттестованная стандартная неопределённость самого положения"
    }
    DEVIATION_NO_U { en: "no uncertainty is certified", ru: "неопределённость не аттестована" }

    EARTH_RATE { en: "Earth rate ω₃ along x and y", ru: "Угловая скорость Земли ω₃ по x и y" }
    EARTH_RATE_DIFFERENCE { en: "ω₃: real less ideal", ru: "ω₃: реальная минус идеальная" }
    SPECIFIC_FORCE { en: "Specific force n along x and y", ru: "Перегрузка n по x и y" }
    SPECIFIC_FORCE_DIFFERENCE { en: "n: real less ideal", ru: "n: реальная минус идеальная" }
    VECTOR_IN_WORDS { en: "position {index}: x {x}, y {y}", ru: "положение {index}: x {x}, y {y}" }
    VECTORS_DESCRIPTION { en: "In {unit}: {list}.", ru: "В {unit}: {list}." }
    VECTOR_REAL { en: "as certified", ru: "по результатам аттестации" }
    VECTOR_IDEAL { en: "of a stand without deviations", ru: "для стенда без отклонений" }
    VECTOR_MARKS {
        en: "another mark for each frame index i; labels are i,j",
        ru: "для каждого индекса рамки i свой знак; подписи — i,j"
    }

    PLACE_TITLE { en: "Where the passport is valid", ru: "Где действителен паспорт" }
    PLACE_CIRCLE {
        en: "Within {radius} m of the site at latitude {latitude}°, longitude {longitude}°.",
        ru: "Не далее {radius} м от места с широтой {latitude}° и долготой {longitude}°."
    }
    PLACE_BAND {
        en: "Within {radius} m north and south of the latitude {latitude}°; no longitude is stated.",
        ru: "Не далее {radius} м к северу и югу от широты {latitude}°; долгота не указана."
    }
    PLACE_MARK_IN_WORDS {
        en: "The azimuth mark is at {azimuth}°, clockwise from north.",
        ru: "Азимут на ориентирный пункт {azimuth}°, от севера по часовой стрелке."
    }
    PLACE_NO_MARK_IN_WORDS { en: "No azimuth mark is given.", ru: "Ориентирный пункт не указан." }
    PLACE_SITE { en: "the site", ru: "место установки" }
    PLACE_LIMIT { en: "limit of validity", ru: "граница применимости" }
    PLACE_MARK { en: "direction of the azimuth mark", ru: "направление на ориентирный пункт" }
    LATITUDE { en: "latitude", ru: "широта" }
    LONGITUDE { en: "longitude", ru: "долгота" }
    AZIMUTH { en: "azimuth", ru: "азимут" }

    ACCURACY_TITLE {
        en: "Standard uncertainty of a calibration against the tolerance of the type",
        ru: "Стандартная неопределённость калибровки в сравнении с допуском типа"
    }
    ACCURACY_AXIS { en: "% of the tolerance", ru: "% допуска" }
    ACCURACY_IN_WORDS {
        en: "{parameter}: u = {u} {unit}, {share} % of the tolerance",
        ru: "{parameter}: u = {u} {unit}, {share} % допуска"
    }
    ACCURACY_NO_TOLERANCE_IN_WORDS {
        en: "{parameter}: u = {u} {unit}, the tolerance is 0",
        ru: "{parameter}: u = {u} {unit}, допуск равен 0"
    }
    ACCURACY_U { en: "standard uncertainty u", ru: "стандартная неопределённость u" }
    ACCURACY_EXPANDED { en: "expanded uncertainty U = 2u", ru: "расширенная неопределённость U = 2u" }
    RESIDUALS_TITLE { en: "Residuals along {axis} and their limits", ru: "Остатки по оси {axis} и их границы" }
    RESIDUAL_IN_WORDS { en: "position {index}: {value}, u = {u}", ru: "положение {index}: {value}, u = {u}" }
    RESIDUAL { en: "residual: what the fit leaves of an equation", ru: "остаток уравнения после оценивания" }
    RESIDUAL_LIMITS {
        en: "limits ±2u, with the residual's standard uncertainty u",
        ru: "границы ±2u, где u — стандартная неопределённость остатка"
    }

    TOLERANCES_TITLE { en: "Parameters against their tolerance", ru: "Параметры в сравнении с допуском" }
    TOLERANCE_IN_WORDS {
        en: "{parameter}: deviation {deviation}, U = {expanded}, tolerance ±{tolerance} {unit}: {decision}",
        ru: "{parameter}: отклонение {deviation}, U = {expanded}, допуск ±{tolerance} {unit}: {decision}"
    }
    TOLERANCES_WHISKER { en: "expanded uncertainty ±U, U = 2u", ru: "расширенная неопределённость ±U, U = 2u" }
    TOLERANCES_GUARDED {
        en: "guarded acceptance: within the tolerance less U",
        ru: "приёмка с защитной полосой: в пределах допуска за вычетом U"
    }
    TOLERANCES_LIMIT { en: "tolerance", ru: "допуск" }
    DECISION_PASS { en: "pass", ru: "годен" }
    DECISION_FAIL { en: "fail", ru: "не годен" }
    DECISION_UNDECIDED { en: "undecided", ru: "не определено" }

    CONVERGENCE_TITLE {
        en: "Successive approximation: what each step moved, over its limit",
        ru: "Последовательные приближения: изменение на каждом шаге, отнесённое к пределу"
    }
    CONVERGENCE_STEP { en: "step; the first approximation is 1", ru: "шаг; первое приближение — 1" }
    CONVERGENCE_K { en: "main scale factors, the one that moved more", ru: "основные масштабные коэффициенты, наибольшее" }
    CONVERGENCE_G { en: "g-sensitive drifts, the one that moved more", ru: "составляющие дрейфа от g, наибольшее" }
    CONVERGENCE_LIMIT { en: "below it both stop", ru: "ниже неё процесс останавливается" }
    CONVERGENCE_IN_WORDS { en: "step {step}: {k} % and {g} °/h/g", ru: "шаг {step}: {k} % и {g} °/ч/g" }
    CONVERGENCE_DESCRIPTION {
        en: "Limits: {k} % of the main scale factors, {g} °/h/g of the g-sensitive drifts. Moved by {list}.",
        ru: "Пределы: {k} % основных масштабных коэффициентов, {g} °/ч/g составляющих дрейфа от g. Изменения: {list}."
    }
    ACCURACY_LIMIT { en: "beyond the tolerance: nothing can be decided", ru: "за пределами допуска: решение невозможно" }
}
