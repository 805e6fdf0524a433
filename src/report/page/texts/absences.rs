//! What a passport does not state, and what that costs.

use super::texts;

texts! {
    UNCERTAINTY {
        en: "No uncertainty of the deviations is certified: none can be stated.",
        ru: "Неопределённость отклонений не аттестована: указать её нельзя."
    }
    REPEATABILITY {
        en: "No repeatability is certified: what a return to a position adds is unknown.",
        ru: "Повторяемость не аттестована: вклад возвращения в положение неизвестен."
    }
    COMMON_PART {
        en: "The part common to all positions is not certified for platform and base: it is unknown.",
        ru: "Составляющая, общая для всех положений, не аттестована для платформы и основания: она неизвестна."
    }
    TRACEABILITY {
        en: "No traceability is stated: the deviations are numbers, not traceable measurements.",
        ru: "Прослеживаемость не указана: отклонения — числа, а не прослеживаемые измерения."
    }
    TEMPERATURE {
        en: "No temperature is certified: whether the deviations hold at another one is unknown.",
        ru: "Температура не указана: верны ли отклонения при другой температуре, неизвестно."
    }
    LAST_DAY {
        en: "The certificate names no last day: who uses the stand decides when to have it certified again.",
        ru: "Срок действия сертификата не указан: когда аттестовать стенд снова, решает его владелец."
    }
    DATUM {
        en: "No datum is stated: which surfaces to level, to turn north and to seat the gyro on is unknown.",
        ru: "Базовые поверхности не указаны: неизвестно, какую горизонтировать, какую направлять на север и на какую \
             устанавливать гироскоп."
    }
    EIGHT_POSITIONS {
        en: "Not all of the eight positions are certified: no matrices, least squares alone.",
        ru: "Аттестованы не все восемь положений: нет матриц, применим только метод наименьших \
             квадратов."
    }
    DEFLECTION {
        en: "The deflection of the vertical is unknown: taken as 0 with u = {u}″, up to {cost} °/h in the rates.",
        ru: "Уклонение отвесной линии неизвестно: принято равным 0 с u = {u}″, до {cost} °/ч в угловых скоростях."
    }
    LONGITUDE {
        en: "The longitude is unknown: of the place only the latitude can be checked.",
        ru: "Долгота неизвестна: из координат места можно проверить только широту."
    }
    GEODETIC_LATITUDE {
        en: "The geodetic latitude is unknown: the check of place allows {margin}″ for it.",
        ru: "Геодезическая широта неизвестна: при проверке места для неё допускается {margin}″."
    }
    HEIGHT {
        en: "The height is unknown: normal gravity is that at 0 m, {slope} m/s² too large for each metre.",
        ru: "Высота неизвестна: нормальная сила тяжести взята для 0 м, она завышена на {slope} м/с² на каждый метр."
    }
    BASE_UNCERTAINTY {
        en: "No uncertainty of latitude, azimuth and level of the base is stated for this site.",
        ru: "Неопределённости широты, азимута и горизонтирования основания для этого места не указаны."
    }
    AZIMUTH_MARK {
        en: "No azimuth mark is given: north must come from elsewhere.",
        ru: "Ориентирный пункт не указан: направление на север определяют иначе."
    }
}
