//! Words in pictures, and texts of their descriptions.

use super::texts;

texts! {
    DOWNWARDS { en: "down", ru: "низ" }
    NORTH_LETTER { en: "N", ru: "С" }
    EAST_LETTER { en: "E", ru: "В" }
    SOUTH_LETTER { en: "S", ru: "Ю" }
    WEST_LETTER { en: "W", ru: "З" }

    STAND_TITLE { en: "Stand with its parts, axes and angles", ru: "Стенд: части, оси и углы" }
    STAND_DESCRIPTION {
        en: "The frame is rotated by θ about its axis ξ, which points to the azimuth {azimuth}°, the platform by φ \
             in the frame. The platform carries the gyro, whose spin axis is z; the pins of its seat lie along x.",
        ru: "Рамка поворачивается на угол θ вокруг оси ξ, азимут которой {azimuth}°. Платформа поворачивается в рамке \
             на угол φ и несёт гироскоп с осью собственного вращения z; штифты посадочной поверхности расположены вдоль x."
    }
    PART_FRAME { en: "frame", ru: "рамка" }
    PART_PLATFORM { en: "platform", ru: "платформа" }
    PART_PINS { en: "pins, along x", ru: "штифты, вдоль x" }
    PART_GYRO { en: "gyro, spin axis z", ru: "гироскоп с осью z" }
    PART_BASE { en: "base", ru: "основание" }
    PART_AXIS { en: "axis ξ, azimuth {azimuth}°", ru: "ось ξ, азимут {azimuth}°" }

    POSITION_TITLE { en: "Position {index} of the stand", ru: "Положение {index} стенда" }
    POSITION_DESCRIPTION {
        en: "Frame angle θ = {theta}°, platform angle φ = {phi}°. Certified directions of the case \
             axes: x {x} (within {x_angle}°), y {y} (within {y_angle}°), z, the spin axis, {z} (within {z_angle}°).",
        ru: "Угол рамки θ = {theta}°, угол платформы φ = {phi}°. Направления осей корпуса \
             по сертификату: x — {x} (в пределах {x_angle}°), y — {y} (в пределах {y_angle}°), z (ось собственного \
             вращения) — {z} (в пределах {z_angle}°)."
    }
    CASE_AXES { en: "case axes x, y, z, actual", ru: "оси корпуса x, y, z, реальные" }
    CASE_AXES_IDEAL {
        en: "nominal, where the difference is visible",
        ru: "номинальные, где отличие заметно"
    }
    FRAME { en: "frame, rotated by θ about ξ", ru: "рамка, поворот на θ вокруг\u{a0}ξ" }
    PLATFORM {
        en: "platform with the gyro, rotated by φ about z; the pins of its seat lie along x",
        ru: "платформа с гироскопом, поворот на φ вокруг\u{a0}z; штифты вдоль\u{a0}x"
    }

    DEVIATION_BAR {
        en: "certified deviations α, β, γ about x, y, z of the platform",
        ru: "отклонения α, β, γ по сертификату, вокруг осей x, y, z платформы"
    }
    DEVIATION_WHISKER {
        en: "±2u, where u is the own part of the standard uncertainty",
        ru: "±2u, где u — собственная составляющая стандартной неопределённости"
    }
    DEVIATION_WHISKER_UNSEEN {
        en: "±2u is shorter than the lines are wide (u: own part of the standard uncertainty)",
        ru: "±2u меньше толщины линий (u — собственная составляющая стандартной неопределённости)"
    }
    DEVIATION_NO_U { en: "the certificate gives no uncertainty", ru: "неопределённость в сертификате не указана" }

    EARTH_RATE_DIFFERENCE { en: "ω_3: actual minus nominal, {unit}", ru: "Отличие ω_3, {unit}" }
    SPECIFIC_FORCE_DIFFERENCE { en: "n: actual minus nominal, {unit}", ru: "Отличие n, {unit}" }
    EARTH_RATE_OF_FRAME { en: "ω_3, i = {i}, {unit}", ru: "ω_3, i = {i}, {unit}" }
    SPECIFIC_FORCE_OF_FRAME { en: "n, i = {i}, {unit}", ru: "n, i = {i}, {unit}" }
    VECTOR_IN_WORDS { en: "position {index}: x {x}, y {y}", ru: "положение {index}: x {x}, y {y}" }
    VECTORS_DESCRIPTION { en: "In {unit}: {list}.", ru: "В {unit}: {list}." }
    VECTOR_DIFFERENCE { en: "from nominal to actual orientation", ru: "от номинальной к реальной ориентации" }
    VECTOR_LABEL { en: "label: position (i, j)", ru: "подпись: положение (i, j)" }
    VECTOR_MARK { en: "position {positions}", ru: "положение {positions}" }

    PLACE_TITLE { en: "Area of validity of the passport", ru: "Область применимости паспорта" }
    PLACE_CIRCLE {
        en: "Within {radius} m of the site at latitude {latitude}, longitude {longitude}.",
        ru: "От точки {latitude}, {longitude} — не далее {radius} м."
    }
    PLACE_BAND {
        en: "Within {radius} m north or south of latitude {latitude}; no longitude is stated.",
        ru: "Не далее {radius} м к северу и югу от параллели {latitude}; долгота не указана."
    }
    PLACE_MARK_IN_WORDS {
        en: "The azimuth of the mark is {azimuth}°, clockwise from north.",
        ru: "Азимут на ориентирный пункт {azimuth}°, от севера по часовой стрелке."
    }
    PLACE_NO_MARK_IN_WORDS { en: "No azimuth mark is given.", ru: "Ориентирный пункт не указан." }
    PLACE_SITE { en: "the site", ru: "место установки" }
    PLACE_LIMIT { en: "validity radius", ru: "радиус применимости" }
    PLACE_MARK { en: "direction of the azimuth mark", ru: "направление на ориентирный пункт" }
    LATITUDE { en: "latitude", ru: "широта" }
    LONGITUDE { en: "longitude", ru: "долгота" }
    AZIMUTH { en: "azimuth", ru: "азимут" }

    ACCURACY_TITLE {
        en: "Standard uncertainty of a calibration relative to the tolerance of the gyro type",
        ru: "Стандартная неопределённость калибровки в сравнении с допуском типа"
    }
    ACCURACY_IN_WORDS {
        en: "{parameter}: u = {u} {unit}, {share} % of the tolerance",
        ru: "{parameter}: u = {u} {unit}, {share} % допуска"
    }
    ACCURACY_NO_TOLERANCE_IN_WORDS {
        en: "{parameter}: u = {u} {unit}; the tolerance is 0",
        ru: "{parameter}: u = {u} {unit}, допуск равен 0"
    }
    ACCURACY_U { en: "standard uncertainty u", ru: "стандартная неопределённость u" }
    ACCURACY_EXPANDED {
        en: "expanded uncertainty U = 2u, coverage probability about 95 %",
        ru: "расширенная неопределённость U = 2u, вероятность охвата около 95 %"
    }
    RESIDUAL { en: "residual of an equation after the fit", ru: "остаток уравнения после оценивания" }
    RESIDUAL_LIMITS {
        en: "limits ±2u, with u the standard uncertainty of the residual",
        ru: "границы ±2u, где u — стандартная неопределённость остатка"
    }

    CHANGE_BAR { en: "change of the deviation, ″", ru: "изменение отклонения, ″" }
    CHANGE_LIMITS {
        en: "limits ±2u, with u the standard uncertainty of the change",
        ru: "границы ±2u, где u\u{a0}— стандартная неопределённость изменения"
    }

    TOLERANCES_WHISKER { en: "interval ±U", ru: "интервал ±U" }
    TOLERANCES_GUARDED {
        en: "acceptance interval",
        ru: "интервал приёмки"
    }
    TOLERANCES_BEYOND { en: "beyond the axis", ru: "вне шкалы" }
    TOLERANCES_LIMIT { en: "tolerance", ru: "допуск" }
    DECISION_PASS { en: "pass", ru: "соответствует" }
    DECISION_FAIL { en: "fail", ru: "не соответствует" }
    DECISION_UNDECIDED { en: "undecided", ru: "не определено" }
    NOT_ASSESSED { en: "not assessed", ru: "не оценивалось" }

    CONVERGENCE_TITLE {
        en: "Iterative method: change in each step relative to the limit",
        ru: "Итерационный метод: изменение на каждом шаге относительно предела"
    }
    CONVERGENCE_STEP { en: "step", ru: "шаг" }
    CONVERGENCE_SHARE { en: "change/limit", ru: "изменение/предел" }
    CONVERGENCE_K { en: "main scale factors", ru: "основные масштабные коэффициенты" }
    CONVERGENCE_G { en: "g-sensitive drifts", ru: "составляющие дрейфа, зависящие от g" }
    CONVERGENCE_LIMIT { en: "limit", ru: "предел" }
    CONVERGENCE_IN_WORDS {
        en: "step {step}: {k} % and {g} °/(h·g)",
        ru: "шаг {step}: {k} % и {g} °/(ч·g)"
    }
    CONVERGENCE_DESCRIPTION {
        en: "Limits: {k} % for the main scale factors, {g} °/(h·g) for the g-sensitive drifts. Changes: \
             {list}.",
        ru: "Пределы: {k} % для основных масштабных коэффициентов, {g} °/(ч·g) для составляющих дрейфа, \
             зависящих от g. Изменения: {list}."
    }
    ACCURACY_LIMIT {
        en: "U exceeds the tolerance: no pass is possible",
        ru: "U больше допуска: подтвердить соответствие невозможно"
    }
}
