//! Words of the program in a DCC, in every language.

use crate::report::page::language::texts;

texts! {
    BASIC_TERMS { en: "Basic terms of metrology", ru: "Основные метрологические термины" }
    MATH_TERMS { en: "Terms of mathematics", ru: "Математические термины" }
    TEMPERATURE { en: "Temperature during the measurements", ru: "Температура при измерениях" }
    SERIAL { en: "Serial number", ru: "Заводской номер" }
    CONFIGURATION { en: "Configuration", ru: "Исполнение" }
    PASSPORT_ID { en: "Identifier of the signed passport", ru: "Обозначение подписанного паспорта" }
    PREDECESSOR { en: "Signed predecessor of the passport", ru: "Прежний подписанный паспорт" }
    TRACEABILITY { en: "Traceability", ru: "Прослеживаемость" }
    VALID_UNTIL { en: "Valid until (inclusive)", ru: "Действителен по (включительно)" }
    TEMPERATURE_RANGE { en: "Temperature range of validity", ru: "Диапазон применимости по температуре" }
    LOWEST { en: "Lowest temperature", ru: "Наименьшая температура" }
    HIGHEST { en: "Highest temperature", ru: "Наибольшая температура" }
    LEVEL { en: "Datum surface for levelling", ru: "Базовая поверхность для горизонтирования" }
    AZIMUTH { en: "Datum surface for north alignment", ru: "Базовая поверхность для ориентирования на север" }
    SEAT { en: "Gyro seat", ru: "Посадочная поверхность гироскопа" }
    REPEATABILITY {
        en: "Repeatability of positioning: standard deviation of one visit, per axis",
        ru: "Повторяемость положений: стандартное отклонение одной установки в положение, по оси"
    }
    COMMON_PLATFORM {
        en: "Standard uncertainty common to all positions, per axis of the platform",
        ru: "Стандартная неопределённость, общая для всех положений, по оси платформы"
    }
    COMMON_BASE {
        en: "Standard uncertainty common to all positions, per axis of the base",
        ru: "Стандартная неопределённость, общая для всех положений, по оси основания"
    }
    METHOD { en: "Method of measurement", ru: "Методика измерений" }
    STAND_RESULT {
        en: "Deviations of the stand’s positions",
        ru: "Отклонения положений стенда"
    }
    POSITIONS { en: "Positions and their deviations", ru: "Положения и их отклонения" }
    POSITIONS_NOTE {
        en: "Position (i, j): frame angle θ about ξ, then platform angle φ about the spin axis. α, β, γ are the \
             deviations of the actual from the nominal orientation about the axes x, y, z of the platform. Standard \
             uncertainties (k = 1) are the own part of each position; those common to all positions are statements.",
        ru: "Положение (i, j): угол рамки θ вокруг ξ, затем угол платформы φ вокруг оси собственного вращения. α, β, \
             γ — отклонения реальной ориентации от номинальной вокруг осей x, y, z платформы. Стандартные \
             неопределённости (k = 1) — собственная составляющая каждого положения; общие для всех положений \
             приведены отдельно."
    }
    INDEX_I { en: "Frame index i", ru: "Индекс рамки i" }
    INDEX_J { en: "Platform index j", ru: "Индекс платформы j" }
    THETA { en: "Frame angle θ", ru: "Угол рамки θ" }
    PHI { en: "Platform angle φ", ru: "Угол платформы φ" }
    ALPHA { en: "Deviation α", ru: "Отклонение α" }
    BETA { en: "Deviation β", ru: "Отклонение β" }
    GAMMA { en: "Deviation γ", ru: "Отклонение γ" }
    PASSPORT { en: "Signed passport of the stand", ru: "Подписанный паспорт стенда" }
    PASSPORT_NOTE {
        en: "Passport {id}, byte for byte; SHA-256 {sha256}. This DCC is not signed, the passport in it is: save the \
             passport and verify it.",
        ru: "Паспорт {id}, байт в байт; SHA-256 {sha256}. Этот цифровой сертификат калибровки не подписан, подписан \
             вложенный паспорт: его следует сохранить и проверить."
    }
    STAND { en: "Test stand with certified deviations", ru: "Поворотный стенд с отклонениями по сертификату" }
    GYRO { en: "Dynamically tuned gyro", ru: "Динамически настраиваемый гироскоп" }
    GRAVITY { en: "Local gravity", ru: "Местное ускорение g" }
    MODEL {
        en: "Drift model of a dynamically tuned gyro, fitted to its torquer currents in the positions of the stand, \
             with the certified deviations and the Earth-rate vectors of the stand’s passport.",
        ru: "Модель дрейфа динамически настраиваемого гироскопа по токам датчиков момента в положениях стенда с \
             учётом отклонений по сертификату и угловой скорости Земли из паспорта стенда."
    }
    PARAMETERS_NOTE {
        en: "Standard uncertainties (k = 1). The g-sensitive drifts refer to 1 m/s² instead of the local g; their \
             uncertainties include that of the local g.",
        ru: "Стандартные неопределённости (k = 1). Составляющие дрейфа, зависящие от g, отнесены к 1 м/с², а не к \
             местному g; в их неопределённость входит неопределённость местного g."
    }
    SCALE_FACTORS { en: "Scale factors K", ru: "Масштабные коэффициенты K" }
    CONSTANT_DRIFT { en: "Constant drift ω_0", ru: "Постоянная составляющая дрейфа ω_0" }
    G_DRIFT { en: "g-sensitive drift ω_g, ω_k", ru: "Составляющие дрейфа, зависящие от g: ω_g, ω_k" }
    CONFORMITY { en: "Conformity with gyro type {type}", ru: "Соответствие типу {type}" }
    RULE {
        en: "Guarded acceptance with a guard band equal to the expanded uncertainty U, with k = 2 or that of Student’s t \
             for few degrees of freedom, coverage probability 95.45 % (JCGM 106, 8.3): pass or fail. Where the \
             uncertainty does not permit this decision, the decision by simple acceptance is conditional.",
        ru: "Приёмка с защитной полосой, равной расширенной неопределённости U (коэффициент охвата k = 2, при малом числе \
             степеней свободы — коэффициент Стьюдента; вероятность охвата 95,45 %; JCGM 106, 8.3): соответствует или не \
             соответствует. Если неопределённость не позволяет принять такое решение, приводится условное решение по \
             правилу простой приёмки."
    }
    DECISIONS {
        en: "Decisions on conformity, in the order of the values",
        ru: "Решения о соответствии в порядке следования значений"
    }
    LOWER_LIMIT { en: "Lower limit of the tolerance", ru: "Нижняя граница допуска" }
    UPPER_LIMIT { en: "Upper limit of the tolerance", ru: "Верхняя граница допуска" }
    SUSPECT { en: "Reading that is probably wrong", ru: "Показание, вероятно, ошибочно" }
    CONFORMITY_OPEN { en: "Conformity not decided", ru: "Решение о соответствии не принято" }
    NOT_STATED {
        en: "Uncertainty not stated, or stated as 0, and not included",
        ru: "Неопределённость не указана (или равна 0) и не учтена"
    }
    NOT_SIGNED {
        en: "This DCC is not signed. The passport of the stand is signed; its SHA-256 is given with the equipment.",
        ru: "Этот цифровой сертификат калибровки не подписан. Подписан паспорт стенда, его хеш SHA-256 указан в сведениях \
             о средствах калибровки."
    }
}
