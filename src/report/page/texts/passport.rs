//! Texts of the printed passport: content of the signed file.

use super::texts;

texts! {
    TITLE { en: "Passport of a test stand", ru: "Паспорт поворотного стенда" }
    MARGIN_PASSPORT { en: "Passport {stand}/{site}, revision {revision}", ru: "Паспорт {stand}/{site}, редакция {revision}" }
    MARGIN_SHA256 { en: "SHA-256 of the signed file {sha256}", ru: "SHA-256 подписанного файла {sha256}" }

    STATUS { en: "Status", ru: "Состояние" }
    UNTIL { en: "until", ru: "по" }
    INCLUSIVE { en: "inclusive", ru: "включительно" }
    INCLUSIVE_NOT_CHECKED {
        en: "inclusive; withdrawal not checked",
        ru: "включительно; отзыв не\u{a0}проверялся"
    }
    PERIOD { en: "validity period: until {day} (inclusive)", ru: "срок действия по {day} включительно" }
    NO_END { en: "no expiry date is stated", ru: "срок действия не указан" }
    NO_END_NOT_CHECKED {
        en: "no expiry date is stated; withdrawal not checked",
        ru: "срок действия не указан; отзыв не\u{a0}проверялся"
    }
    WHERE { en: "Use within", ru: "Применять в пределах" }
    AROUND { en: "around", ru: "от" }
    AROUND_PARALLEL { en: "north or south of latitude", ru: "к северу и югу от параллели" }
    WORD { en: "Based on certificate", ru: "На основании сертификата" }
    WITHOUT_UNCERTAINTY { en: "no uncertainty stated", ru: "неопределённость не указана" }
    PASSPORT_ISSUER { en: "Issuer of the passport", ru: "Выдавшая организация" }
    CHECKING { en: "How to check", ru: "Как проверить" }
    CHECKING_HOW {
        en: "of the file: must match that in the QR code; for all checks run dtg-passport verify",
        ru: "файла должен совпадать с хешем в QR-коде; все проверки выполняет dtg-passport verify"
    }
    FIGURE_STAND {
        en: "The stand: its axes and angles, for θ = 40° and φ = 35°, with the axis ξ of the frame at its azimuth at this site.",
        ru: "Оси и углы стенда при θ = 40° и φ = 35°, азимут оси рамки ξ — для места установки."
    }

    FRONT { en: "Identity and verification", ru: "Идентификация и проверка" }
    ID { en: "Passport", ru: "Паспорт" }
    REVISION { en: "Revision", ru: "Редакция" }
    ISSUED { en: "Issued", ru: "Выдан" }
    ISSUER { en: "Issuer", ru: "Выдавшая организация" }
    KEY { en: "Key fingerprint", ru: "Отпечаток ключа" }
    VALID_UNTIL { en: "Valid until (inclusive)", ru: "Действителен по (включительно)" }
    ISSUED_WITH { en: "Program", ru: "Программа" }
    REISSUED_FROM { en: "Predecessor", ru: "Прежний паспорт" }
    REISSUED_SHA256 { en: "SHA-256 of the predecessor", ru: "SHA-256 прежнего паспорта" }
    REISSUE_REASON { en: "Reason for re-issue", ru: "Причина перевыпуска" }
    REISSUE_CHANGED { en: "Changes", ru: "Изменения" }
    REISSUE_SUPERSEDES { en: "Supersedes the predecessor", ru: "Прежний паспорт заменён" }
    SHA256 { en: "SHA-256 of the signed file", ru: "SHA-256 подписанного файла" }
    CODE { en: "QR code with the SHA-256 of the signed file", ru: "QR-код с SHA-256 подписанного файла" }
    PAPER_IS_NOT_SIGNED {
        en: "This page has no digital signature: only the file, reproduced verbatim in the annex, is authoritative. Its SHA-256 \
             must equal the value here and in the QR code. dtg-passport verify checks the file, ssh-keygen its signature alone.",
        ru: "Страница не имеет электронной подписи: силу имеет только файл, дословно приведённый в приложении. Его хеш \
             SHA-256 должен совпадать с указанным здесь и в QR-коде. Файл проверяют командой dtg-passport verify, одну лишь \
             подпись — ssh-keygen."
    }

    GENERAL { en: "General data", ru: "Основные сведения об изделии" }
    STAND { en: "The stand", ru: "Стенд" }
    MANUFACTURER { en: "Manufacturer", ru: "Изготовитель" }
    MODEL { en: "Model", ru: "Модель" }
    SERIAL { en: "Serial number", ru: "Заводской номер" }
    CONFIGURATION { en: "Configuration", ru: "Исполнение" }
    NAME { en: "Name", ru: "Наименование" }
    CUSTOMER { en: "Customer", ru: "Заказчик" }
    CERTIFICATE { en: "Calibration certificate", ru: "Сертификат калибровки" }
    CERTIFICATE_NUMBER { en: "Number", ru: "Номер" }
    CERTIFICATE_ISSUED { en: "Date of issue", ru: "Дата выдачи" }
    PERFORMED { en: "Date of measurement", ru: "Дата измерений" }
    RECEIVED { en: "Stand received", ru: "Дата поступления стенда" }
    VALID_UNTIL_BASIS { en: "Basis of validity period", ru: "Основание срока действия" }
    LABORATORY { en: "Laboratory", ru: "Лаборатория" }
    LABORATORY_OF_CERTIFICATE { en: "Laboratory of the certificate", ru: "Лаборатория, выдавшая сертификат" }
    ADDRESS { en: "Address", ru: "Адрес" }
    AUTHORISED_BY { en: "Authorised by", ru: "Утвердил" }
    ACCREDITATION { en: "Accreditation", ru: "Аккредитация" }
    METHOD { en: "Method", ru: "Методика" }
    TRACEABILITY { en: "Traceability", ru: "Прослеживаемость" }
    TEMPERATURE { en: "Temperature during measurement", ru: "Температура при измерениях" }
    TEMPERATURE_RANGE { en: "Temperature range of validity", ru: "Диапазон температур применения" }
    FROM_TO { en: "{low} to {high}", ru: "от {low} до {high}" }
    THIS_ITEM_ONLY {
        en: "The results relate only to the stand identified here. This passport shall not be reproduced except in full \
             without the written approval of the laboratory. The calibration results include no statement of conformity, \
             no opinion and no interpretation.",
        ru: "Результаты относятся только к указанному здесь стенду. Частичное воспроизведение паспорта без письменного \
             согласия лаборатории не допускается. Результаты калибровки не включают заключений о соответствии, мнений и \
             интерпретаций."
    }

    CHARACTERISTICS { en: "Characteristics", ru: "Основные технические данные" }
    DEVIATIONS { en: "Certified deviations of the positions", ru: "Отклонения положений по сертификату" }
    DEVIATIONS_CAPTION {
        en: "Nominal angles, and certified deviations of the actual orientation from the nominal",
        ru: "Номинальные углы и отклонения реальной ориентации от номинальной"
    }
    DEVIATIONS_NOTE {
        en: "Position (i, j): frame angle θ about ξ, then platform angle φ about the spin axis. α, β, γ define the \
             coordinate transformation from the platform axes in the nominal orientation to those in the actual one, \
             eq. (4) of Tang and Podchezertsev (2017).",
        ru: "Положение (i, j): угол рамки θ вокруг ξ, затем угол платформы φ вокруг оси собственного вращения. α, β, γ \
             задают преобразование координат из осей платформы при номинальной ориентации в оси при реальной, формула (4) работы Тан Синюаня и В. П. Подчезерцева (2017)."
    }
    DEVIATIONS_U_NOTE {
        en: "u: own part of the standard uncertainty (k = 1) of the certified mean; ν: degrees of freedom, the smallest \
             of those of the three u (–: not stated).",
        ru: "u — собственная составляющая стандартной неопределённости (k = 1) среднего по сертификату; ν — число степеней \
             свободы, наименьшее у трёх u (прочерк — не указано)."
    }
    DEVIATIONS_ROUNDED {
        en: "Uncertainties have two significant digits; values are rounded to the same decimal place.",
        ru: "Неопределённости приведены с двумя значащими цифрами, значения округлены до того же разряда."
    }
    FIGURE_POSITIONS {
        en: "The stand in its positions (i, j), viewed as in Figure 1. Deviations are drawn ×{factor}.",
        ru: "Стенд в положениях (i, j); вид тот же, что на рисунке\u{a0}1. Увеличение отклонений: ×{factor}."
    }
    COMMON {
        en: "Repeatability and common parts of the uncertainty (k = 1)",
        ru: "Повторяемость и общие составляющие неопределённости (k = 1, по каждой оси)"
    }
    REPEATABILITY { en: "Repeatability of positioning, per axis", ru: "Повторяемость положений" }
    REPEATABILITY_DOF { en: "Degrees of freedom ν", ru: "Число степеней свободы ν" }
    COMMON_PLATFORM { en: "Common part, per axis of the platform", ru: "Общая составляющая платформы" }
    COMMON_BASE { en: "Common part, per axis of the base", ru: "Общая составляющая основания" }
    TYPE_B_POSITION { en: "Type B, part of u(α), u(β), u(γ)", ru: "По типу B, в составе u(α), u(β), u(γ)" }
    TYPE_B_PLATFORM {
        en: "Type B, common part of the platform",
        ru: "По типу B, общая составляющая платформы"
    }
    TYPE_B_BASE { en: "Type B, common part of the base", ru: "По типу B, общая составляющая основания" }
    EXCLUDED_READING {
        en: "excluded: position {index}, run {run}",
        ru: "исключено: положение {index}, серия {run}"
    }
    EXCLUDED_RUN { en: "excluded: run {run}", ru: "исключена серия {run}" }
    EVIDENCE { en: "Number of runs, file of readings", ru: "Число серий, файл показаний" }
    DATUM { en: "Datum surfaces", ru: "Базовые поверхности" }
    DATUM_LEVEL { en: "Surface for levelling", ru: "Поверхность для горизонтирования" }
    DATUM_AZIMUTH { en: "Surface for north alignment", ru: "Поверхность для ориентирования на север" }
    DATUM_SEAT { en: "Gyro seat", ru: "Посадочная поверхность гироскопа" }

    SITE { en: "Site (place of delivery)", ru: "Место установки (место поставки)" }
    SITE_ID { en: "Identifier", ru: "Обозначение" }
    LATITUDE { en: "Geodetic latitude (WGS 84)", ru: "Геодезическая широта (WGS 84)" }
    ASTRONOMIC_LATITUDE { en: "Astronomic latitude, given", ru: "Астрономическая широта, заданная" }
    LONGITUDE { en: "Longitude", ru: "Долгота" }
    HEIGHT { en: "Height above the ellipsoid", ru: "Высота над эллипсоидом" }
    DEFLECTION { en: "Deflection of the vertical", ru: "Уклонение отвесной линии" }
    GRAVITY_MEASURED { en: "Gravity g, measured", ru: "Ускорение g, измеренное" }
    MARK { en: "Azimuth mark", ru: "Ориентирный пункт" }
    MARK_POSITION { en: "Latitude and longitude of the mark", ru: "Широта и долгота пункта" }
    PILLAR_POSITION { en: "Latitude and longitude of the pillar", ru: "Широта и долгота пилона" }
    POSITION_U { en: "u of each of these coordinates", ru: "u каждой из этих координат" }
    FRAME_AXIS { en: "Azimuth of the frame’s axis ξ", ru: "Азимут оси рамки ξ" }
    LATITUDE_U { en: "u of the latitude", ru: "u широты" }
    AZIMUTH_U { en: "u of the azimuth of the base", ru: "u азимута основания" }
    LEVEL_U { en: "u of the level of the base", ru: "u наклона основания" }
    SOURCE { en: "Source of the data", ru: "Источник этих данных" }
    EARTH { en: "Earth parameters at the site", ru: "Параметры Земли в месте установки" }
    EARTH_RATE { en: "Earth rate Ω", ru: "Угловая скорость Земли Ω" }
    EARTH_LATITUDE { en: "Astronomic latitude Φ", ru: "Астрономическая широта Φ" }
    HORIZONTAL { en: "Horizontal component, Ω\u{a0}cos\u{a0}Φ", ru: "Горизонтальная составляющая, Ω\u{a0}cos\u{a0}Φ" }
    VERTICAL { en: "Vertical component, Ω\u{a0}sin\u{a0}Φ", ru: "Вертикальная составляющая, Ω\u{a0}sin\u{a0}Φ" }
    GRAVITY { en: "Gravity g, local", ru: "Ускорение g, местное" }
    RADIUS { en: "Validity radius", ru: "Радиус применимости" }
    RADIUS_WITHIN {
        en: "Change of the Earth-rate components at this radius",
        ru: "Изменение составляющих угловой скорости Земли на границе"
    }
    AZIMUTH { en: "Astronomic azimuth of the mark", ru: "Астрономический азимут пункта" }

    FIGURE_RADIUS { en: "Area of validity of the passport.", ru: "Область применимости паспорта." }

    NUMBERS { en: "Calibration data", ru: "Данные для калибровки" }
    MATRICES_CAPTION {
        en: "Matrices at the site, by rows; eq. (9) to\u{a0}(15)",
        ru: "Матрицы для места установки, по строкам; формулы (9)–(15)"
    }
    MATRIX { en: "Matrix", ru: "Матрица" }
    UNIT { en: "Unit", ru: "Единица" }
    FORMULAS {
        en: "With the differences of the currents as columns, the scale factors, the g-sensitive drifts and the \
             constant drift are:",
        ru: "Масштабные коэффициенты и составляющие дрейфа по разностям токов, записанным столбцами:"
    }
    MEAN { en: "mean over all positions of", ru: "среднее по всем положениям от" }
    VECTORS { en: "Vectors of the positions", ru: "Векторы положений" }
    VECTORS_ALONE_CAPTION {
        en: "Specific force n and Earth rate ω_3 in case axes",
        ru: "Перегрузка n и угловая скорость Земли ω_3 в осях корпуса гироскопа"
    }
    VECTORS_CAPTION {
        en: "Specific force n and Earth rate ω_3 in case axes, and currents J of the self-check",
        ru: "Перегрузка n и угловая скорость Земли ω_3 в осях корпуса гироскопа и токи J контрольного примера"
    }
    FIGURE_VECTORS {
        en: "Earth rate and specific force in case axes: differences from those in the nominal orientation.",
        ru: "Угловая скорость Земли и перегрузка в осях корпуса: отличия от значений при номинальной ориентации."
    }
    SELF_CHECK { en: "Self-check", ru: "Контрольный пример" }
    SELF_CHECK_NOTE {
        en: "From the currents J of the self-check (use all digits given in the annex), laboratory software should obtain \
             these parameters with a relative error of at most 10⁻⁹:",
        ru: "По токам J (все цифры — в приложении) программа лаборатории должна получить следующие параметры с \
             относительной погрешностью не более 10⁻⁹:"
    }
    EQUATIONS_NOTE {
        en: "Equation numbers: Tang and Podchezertsev (2017), {source}.",
        ru: "Номера формул: Тан Синюань, Подчезерцев В. П. (2017), {source}."
    }
    DIGITS_NOTE {
        en: "The numbers in this section are rounded to nine decimals. For computation, use the annex, which gives all \
             digits.",
        ru: "Числа этого раздела округлены до девяти знаков после запятой; для вычислений берут числа из приложения \
             (все цифры)."
    }
    SCALE_FACTORS_MAIN { en: "Main scale factors", ru: "Основные масштабные коэффициенты" }
    SCALE_FACTORS_CROSS { en: "Cross-axis scale factors", ru: "Перекрёстные масштабные коэффициенты" }
    DRIFT_CONSTANT { en: "Constant drift", ru: "Постоянная составляющая дрейфа" }
    DRIFT_G { en: "g-sensitive drift", ru: "Составляющие дрейфа, зависящие от\u{a0}g" }
    VALUE { en: "Value", ru: "Значение" }
    NO_MATRICES {
        en: "Some of the eight standard positions are not certified, so there are no matrices. Calibrate by least \
             squares, with the vectors below.",
        ru: "В сертификате не все восемь положений, поэтому матриц нет. Калибровку выполняют методом наименьших \
             квадратов по приведённым ниже векторам."
    }

    ACCURACY { en: "Expected calibration uncertainty", ru: "Ожидаемая неопределённость калибровки" }
    ACCURACY_CAPTION {
        en: "Standard uncertainties (k = 1) of one calibration at this site by least squares, and the \
             tolerances of the gyro type; ω_g and ω_k refer to local g, whose own uncertainty is not included",
        ru: "Стандартные неопределённости (k = 1) одной калибровки в этом месте методом наименьших квадратов \
             и допуски типа гироскопа; ω_g и ω_k отнесены к местному g, неопределённость которого не включена"
    }
    ACCURACY_NONE {
        en: "Not stated: the passport was issued without a gyro type and a current meter.",
        ru: "Не указана: паспорт выдан без указания типа гироскопа и измерителя тока."
    }
    FIGURE_ACCURACY {
        en: "Uncertainties relative to the tolerances.",
        ru: "Неопределённости в сравнении с допусками."
    }
    GYRO_TYPE { en: "Gyro type", ru: "Тип гироскопа" }
    GYRO_GRAVITY { en: "g to which the type’s drifts refer", ru: "g, заданное для типа" }
    CALIBRATING_LABORATORY { en: "Laboratory that calibrates the gyro", ru: "Лаборатория, калибрующая гироскоп" }
    METER { en: "Current meter: u (k = 1), range", ru: "Измеритель тока: u (k = 1), диапазон" }
    METER_READING { en: "{n} % of reading", ru: "{n} % показания" }
    METER_GAIN { en: "gain {n} %", ru: "коэффициент преобразования {n} %" }
    METER_OFFSET { en: "offset {n} mA", ru: "смещение нуля {n} мА" }
    METER_FLOOR { en: "floor {n} mA", ru: "постоянная часть погрешности {n} мА" }
    METER_NOISE { en: "noise of a reading {n} mA", ru: "шум показания {n} мА" }
    METER_RANGE { en: "range {n} mA", ru: "диапазон {n} мА" }
    SEATING { en: "u of the gyro seat about x, y, z", ru: "u угла посадки вокруг x, y, z" }
    BASE_AZIMUTH_U { en: "u of the base azimuth, laboratory", ru: "u азимута основания в лаборатории" }
    BASE_LEVEL_U { en: "u of the base level, laboratory", ru: "u наклона основания в лаборатории" }
    LABORATORY_TEMPERATURE { en: "Temperature in the laboratory", ru: "Температура в лаборатории" }
    NOMINAL { en: "Nominal value", ru: "Номинальное значение" }
    TOLERANCE { en: "Tolerance (%: of nominal)", ru: "Допуск (% — от номинального)" }

    ABSENCES { en: "Missing information", ru: "Недостающие сведения" }
    ABSENCES_NONE {
        en: "Nothing that affects the use of the passport is missing.",
        ru: "Все сведения, влияющие на применение паспорта, указаны."
    }

    ANNEX { en: "Annex: the signed file", ru: "Приложение: подписанный файл" }
    ANNEX_NOTE {
        en: "The signed file, verbatim; every number reads back as the same binary64. Saved as {name}, with one line \
             feed at the end of each line, the file has the SHA-256 given on the first page.",
        ru: "Подписанный файл, дословно; каждое число читается как то же значение binary64. Файл, сохранённый под \
             именем {name}, с одним переводом строки в конце каждой строки, имеет хеш SHA-256, указанный на первой \
             странице."
    }
    SAVE { en: "Save the signed file", ru: "Сохранить подписанный файл" }
    END { en: "End of the passport {id}", ru: "Конец паспорта {id}" }
}
