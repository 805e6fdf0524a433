//! Texts about inputs that a passport does not state, and the effect of each.

use super::texts;

texts! {
    UNCERTAINTY {
        en: "The certificate gives no uncertainty of the deviations; it cannot be stated.",
        ru: "Неопределённость отклонений в сертификате не указана и не может быть приведена."
    }
    SOME_UNCERTAINTY {
        en: "The certificate gives no uncertainty of {missing} of the {all} deviations, which count as exact.",
        ru: "Неопределённость отклонений в сертификате указана не для всех: без неё {missing} из {all}, эти отклонения \
             приняты точными."
    }
    REPEATABILITY {
        en: "The certificate gives no repeatability; the uncertainty that positioning adds is unknown.",
        ru: "Повторяемость положений в сертификате не указана; вклад повторяемости в неопределённость неизвестен."
    }
    COMMON_PART {
        en: "The certificate does not give the uncertainty common to all positions for both platform and base.",
        ru: "Составляющая неопределённости, общая для всех положений, не указана для платформы или основания."
    }
    TRACEABILITY {
        en: "No traceability is stated; the deviations are not shown to be traceable to the SI.",
        ru: "Прослеживаемость не указана; связь отклонений с единицами СИ не подтверждена."
    }
    TEMPERATURE {
        en: "The certificate gives no temperature; the validity of the deviations at other temperatures is unknown.",
        ru: "Температура не указана; применимость отклонений при другой температуре неизвестна."
    }
    LAST_DAY {
        en: "The certificate has no expiry date; the user sets the recertification interval.",
        ru: "Срок действия сертификата не указан; срок повторной калибровки устанавливает пользователь стенда."
    }
    DATUM {
        en: "No datum surfaces are stated; the surfaces for levelling, for north alignment and for seating the gyro \
             are unknown.",
        ru: "Базовые поверхности не указаны: неизвестны поверхности для горизонтирования, для ориентирования на север \
             и посадочная поверхность гироскопа."
    }
    EIGHT_POSITIONS {
        en: "Some of the eight standard positions are not certified; there are no matrices, and only least squares \
             applies.",
        ru: "В сертификате не все восемь положений: матриц нет, применим только метод наименьших квадратов."
    }
    DEFLECTION {
        en: "The deflection of the vertical is unknown; it is taken as 0 with u = {u}″, which contributes u = {cost} °/h \
             at most to a component of the Earth rate.",
        ru: "Уклонение отвесной линии неизвестно: принято равным 0 с u = {u}″, что даёт u не более {cost} °/ч для каждой \
             из составляющих угловой скорости Земли."
    }
    LONGITUDE {
        en: "The longitude is unknown; only the latitude of a place can be checked.",
        ru: "Долгота неизвестна: может быть проверена только широта места."
    }
    GEODETIC_LATITUDE {
        en: "The geodetic latitude is unknown; the check of the place allows {margin}″ for it.",
        ru: "Геодезическая широта неизвестна: при проверке места допускается отличие {margin}″."
    }
    HEIGHT {
        en: "The height is unknown; normal gravity is that at 0 m, which is {slope} m/s² too large for each metre of \
             height.",
        ru: "Высота неизвестна: нормальное ускорение силы тяжести вычислено для высоты 0 м и завышено на {slope} м/с² на \
             каждый метр высоты."
    }
    BASE_UNCERTAINTY {
        en: "The uncertainties of the latitude, azimuth and level of the base are not stated for this site.",
        ru: "Неопределённости широты, азимута и наклона основания для этого места установки не указаны."
    }
    LATITUDE_UNCERTAINTY {
        en: "The uncertainty of the latitude is not stated for this site.",
        ru: "Неопределённость широты для этого места установки не указана."
    }
    AZIMUTH_UNCERTAINTY {
        en: "The uncertainty of the azimuth of the base is not stated for this site.",
        ru: "Неопределённость азимута основания для этого места установки не указана."
    }
    LEVEL_UNCERTAINTY {
        en: "The uncertainty of the level of the base is not stated for this site.",
        ru: "Неопределённость наклона основания для этого места установки не указана."
    }
    AZIMUTH_MARK {
        en: "No azimuth mark is given; the north direction must be determined in another way.",
        ru: "Ориентирный пункт не указан; направление на север определяют иным способом."
    }
}
