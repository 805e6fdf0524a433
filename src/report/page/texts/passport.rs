//! The printable passport: what the signed file says.

use super::texts;

texts! {
    TITLE { en: "Passport of a test stand", ru: "Паспорт испытательного стенда" }
    SUBTITLE {
        en: "Two-axis test stand for dynamically tuned gyros (DTG): certified deviations of its positions, and what a \
             calibration at the place of delivery needs",
        ru: "Двухосный поворотный стенд для динамически настраиваемых гироскопов (ДНГ): аттестованные отклонения положений \
             и данные для калибровки в месте поставки"
    }
    MARGIN_PASSPORT { en: "Passport {stand}/{site}, revision {revision}", ru: "Паспорт {stand}/{site}, редакция {revision}" }
    MARGIN_SHA256 { en: "SHA-256 of the signed file {sha256}", ru: "SHA-256 подписанного файла {sha256}" }

    FRONT { en: "Identity and verification", ru: "Идентификация и проверка" }
    ID { en: "Passport", ru: "Паспорт" }
    REVISION { en: "Revision", ru: "Редакция" }
    ISSUED { en: "Issued", ru: "Выдан" }
    ISSUER { en: "Signed by", ru: "Кем подписан" }
    KEY { en: "Fingerprint of the key", ru: "Отпечаток ключа" }
    VALID_UNTIL { en: "Last day of validity", ru: "Последний день действия" }
    ISSUED_WITH { en: "Written with", ru: "Программа" }
    REISSUED_FROM { en: "Re-issued from", ru: "Выдан взамен" }
    REISSUED_SHA256 { en: "SHA-256 of that file", ru: "SHA-256 прежнего файла" }
    REISSUE_REASON { en: "Reason of the re-issue", ru: "Причина перевыпуска" }
    REISSUE_CHANGED { en: "What changed", ru: "Что изменилось" }
    REISSUE_SUPERSEDES { en: "The earlier one is superseded", ru: "Прежний паспорт заменён" }
    SHA256 { en: "SHA-256 of the signed file", ru: "SHA-256 подписанного файла" }
    CODE { en: "Code with the SHA-256 of the signed file", ru: "Код с SHA-256 подписанного файла" }
    PAPER_IS_NOT_SIGNED {
        en: "This page shows a signed file; the page itself is not signed. What counts is the file, which stands in the annex \
             to the letter. Compare its SHA-256 with the one here or in the code, and verify it with dtg-passport verify, or \
             with ssh-keygen alone.",
        ru: "Эта страница показывает подписанный файл; сама она не подписана. Силу имеет файл, он приведён в приложении \
             дословно. Сравните его SHA-256 с указанной здесь или в коде и проверьте файл командой dtg-passport verify \
             или одной ssh-keygen."
    }

    GENERAL { en: "General data", ru: "Основные сведения об изделии" }
    STAND { en: "The stand", ru: "Стенд" }
    MANUFACTURER { en: "Manufacturer", ru: "Изготовитель" }
    MODEL { en: "Model", ru: "Модель" }
    SERIAL { en: "Serial number", ru: "Заводской номер" }
    CONFIGURATION { en: "Configuration", ru: "Исполнение" }
    NAME { en: "Name", ru: "Наименование" }
    CUSTOMER { en: "Customer", ru: "Заказчик" }
    CERTIFICATE { en: "The certificate", ru: "Сертификат аттестации" }
    CERTIFICATE_NUMBER { en: "Number", ru: "Номер" }
    CERTIFICATE_ISSUED { en: "Issued", ru: "Дата выдачи" }
    PERFORMED { en: "Measured", ru: "Дата измерений" }
    RECEIVED { en: "Stand received", ru: "Дата поступления" }
    CERTIFICATE_VALID_UNTIL { en: "Last day of validity", ru: "Последний день действия" }
    VALID_UNTIL_BASIS { en: "By whose agreement", ru: "Основание срока" }
    LABORATORY { en: "Laboratory", ru: "Лаборатория" }
    ADDRESS { en: "Address", ru: "Адрес" }
    AUTHORISED_BY { en: "Authorised by", ru: "Утвердил" }
    ACCREDITATION { en: "Accreditation", ru: "Аккредитация" }
    METHOD { en: "Method", ru: "Методика" }
    TRACEABILITY { en: "Traceability", ru: "Прослеживаемость" }
    TEMPERATURE { en: "Measured at", ru: "Температура измерений" }
    TEMPERATURE_RANGE { en: "Valid at temperatures of", ru: "Температура применения" }
    FROM_TO { en: "{low} to {high}", ru: "от {low} до {high}" }
    THIS_ITEM_ONLY {
        en: "The results relate only to the stand named here. This passport is to be reproduced in full only, unless the \
             laboratory has agreed in writing. It states no conformity with a specification, no opinion and no \
             interpretation.",
        ru: "Результаты относятся только к указанному здесь стенду. Частичное воспроизведение паспорта без письменного \
             согласия лаборатории не допускается. Паспорт не содержит заключений о соответствии, мнений и толкований."
    }

    CHARACTERISTICS { en: "Characteristics", ru: "Основные технические данные" }
    DEVIATIONS { en: "Certified deviations of the positions", ru: "Аттестованные отклонения положений" }
    DEVIATIONS_CAPTION {
        en: "Nominal angles and certified deviations of the real orientation from them",
        ru: "Номинальные углы и аттестованные отклонения действительной ориентации от них"
    }
    DEVIATIONS_NOTE {
        en: "Position (i, j): frame angle θ about ξ, then platform angle φ about the spin axis. α, β, γ turn coordinates from \
             the nominal to the real platform, eq. (4). u: standard uncertainty (k = 1) of the certified mean, the position's \
             own part; ν: its degrees of freedom. Uncertainties have two significant digits, values end at the same place.",
        ru: "Положение (i, j): угол рамки θ вокруг ξ, затем угол платформы φ вокруг оси вращения ротора. α, β, γ поворачивают \
             координаты от номинальной платформы к действительной, формула (4). u — стандартная неопределённость (k = 1) \
             аттестованного среднего, собственная часть положения; ν — число её степеней свободы. Неопределённости имеют \
             две значащие цифры, значения округлены до того же разряда."
    }
    FIGURE_POSITIONS {
        en: "Figure 1. The stand in its positions (i, j), seen from south-south-east and above.",
        ru: "Рисунок 1. Стенд в положениях (i, j), вид с юго-юго-востока и сверху."
    }
    FIGURE_DEVIATIONS { en: "Figure 2. The certified deviations.", ru: "Рисунок 2. Аттестованные отклонения." }
    COMMON {
        en: "Uncertainty that all positions share (k = 1)",
        ru: "Неопределённость, общая для всех положений (k = 1)"
    }
    REPEATABILITY { en: "Repeatability of a return, per axis", ru: "Повторяемость, по каждой оси" }
    REPEATABILITY_DOF { en: "Its degrees of freedom", ru: "Число её степеней свободы" }
    COMMON_PLATFORM {
        en: "Common, per axis of the platform",
        ru: "Общая, по осям платформы"
    }
    COMMON_BASE { en: "Common, per axis of the base", ru: "Общая, по осям основания" }
    TYPE_B_POSITION { en: "Type B, part of u(α), u(β), u(γ)", ru: "По типу B, в составе u(α), u(β), u(γ)" }
    TYPE_B_PLATFORM { en: "Type B, common part of the platform", ru: "По типу B, общая по платформе" }
    TYPE_B_BASE { en: "Type B, common part of the base", ru: "По типу B, общая по основанию" }
    EVIDENCE { en: "Runs measured, file of readings", ru: "Число серий, файл показаний" }
    DATUM { en: "Datum surfaces", ru: "Базовые поверхности" }
    DATUM_LEVEL { en: "To level", ru: "Горизонтируется" }
    DATUM_AZIMUTH { en: "To point north", ru: "Направляется на север" }
    DATUM_SEAT { en: "Seat of the gyro", ru: "Посадка гироскопа" }

    SITE { en: "Place of delivery", ru: "Место поставки" }
    SITE_ID { en: "Site", ru: "Место" }
    SITE_NAME { en: "Name", ru: "Наименование" }
    LATITUDE { en: "Geodetic latitude (WGS 84)", ru: "Геодезическая широта (WGS 84)" }
    ASTRONOMIC_LATITUDE { en: "Astronomic latitude, as given", ru: "Астрономическая широта, заданная" }
    LONGITUDE { en: "Longitude, east", ru: "Долгота, восточная" }
    HEIGHT { en: "Height above the ellipsoid", ru: "Высота над эллипсоидом" }
    DEFLECTION { en: "Deflection of the vertical", ru: "Уклонение отвесной линии" }
    GRAVITY_MEASURED { en: "Gravity g, measured", ru: "Ускорение g, измеренное" }
    MARK { en: "Azimuth mark", ru: "Ориентирный пункт" }
    MARK_POSITION { en: "Latitude, longitude of the mark", ru: "Широта, долгота пункта" }
    PILLAR_POSITION { en: "Latitude, longitude of the pillar", ru: "Широта, долгота столба" }
    POSITION_U { en: "u of each of these coordinates", ru: "u каждой из этих координат" }
    LATITUDE_U { en: "u of the latitude", ru: "u широты" }
    AZIMUTH_U { en: "u of the base's azimuth", ru: "u азимута основания" }
    LEVEL_U { en: "u of the base's level", ru: "u уровня основания" }
    SOURCE { en: "Source of these numbers", ru: "Источник этих данных" }
    EARTH { en: "The Earth at this place", ru: "Земля в этом месте" }
    EARTH_RATE { en: "Earth rate Ω", ru: "Угловая скорость Земли Ω" }
    EARTH_LATITUDE { en: "Astronomic latitude Φ", ru: "Астрономическая широта Φ" }
    HORIZONTAL { en: "Horizontal part, Ω cos Φ", ru: "Горизонтальная составляющая, Ω cos Φ" }
    VERTICAL { en: "Vertical part, Ω sin Φ", ru: "Вертикальная составляющая, Ω sin Φ" }
    GRAVITY { en: "Gravity g of the drifts per g", ru: "Ускорение g для дрейфов" }
    RADIUS { en: "Radius of validity", ru: "Радиус действия" }
    RADIUS_WITHIN { en: "Change of the rates there", ru: "Изменение скоростей там" }
    AZIMUTH { en: "Astronomic azimuth of the mark", ru: "Астрономический азимут пункта" }

    FIGURE_RADIUS {
        en: "Figure 3. Where the passport may be used.",
        ru: "Рисунок 3. Где применим паспорт."
    }

    NUMBERS { en: "Data for the calibration", ru: "Данные для калибровки" }
    MATRICES { en: "Matrices", ru: "Матрицы" }
    MATRICES_CAPTION {
        en: "Matrices at this place, by rows; eq. (9) to (15)",
        ru: "Матрицы для этого места, по строкам; формулы (9)–(15)"
    }
    MATRIX { en: "Matrix", ru: "Матрица" }
    UNIT { en: "Unit", ru: "Единица" }
    FORMULAS {
        en: "With the differences of the currents as columns, the scale factors, the drifts that depend on g and the constant \
             drift follow:",
        ru: "По разностям токов, взятым столбцами, определяются масштабные коэффициенты, составляющие дрейфа, зависящие от g, \
             и постоянные составляющие дрейфа:"
    }
    MEAN { en: "mean over all positions of", ru: "среднее по всем положениям от" }
    VECTORS { en: "Vectors of the positions", ru: "Векторы положений" }
    VECTORS_ALONE_CAPTION {
        en: "Specific force n and Earth rate ω in the axes of the gyro's case",
        ru: "Перегрузка n и угловая скорость Земли ω в осях корпуса гироскопа"
    }
    VECTORS_CAPTION {
        en: "Specific force n and Earth rate ω in the axes of the gyro's case, and currents J of the self-check",
        ru: "Перегрузка n и угловая скорость Земли ω в осях корпуса гироскопа и токи J контрольного примера"
    }
    FIGURE_VECTORS {
        en: "Figure 4. Earth rate and specific force in the axes of the gyro's case, and how far they are from those of an \
             ideal stand.",
        ru: "Рисунок 4. Угловая скорость Земли и перегрузка в осях корпуса гироскопа и их отличие от значений для идеального \
             стенда."
    }
    SELF_CHECK { en: "Self-check", ru: "Контрольный пример" }
    SELF_CHECK_NOTE {
        en: "From the currents J of the self-check, taken from the annex in full, correct laboratory software finds these \
             parameters:",
        ru: "По токам J контрольного примера, взятым из приложения полностью, правильная программа лаборатории находит \
             следующие параметры:"
    }
    DIGITS_NOTE {
        en: "Numbers of this section are rounded to nine decimals for reading. To compute, take them from the annex, where \
             every number stands in full.",
        ru: "Числа этого раздела округлены для чтения до девяти знаков после запятой. Для вычислений берите их из приложения, \
             где каждое число приведено полностью."
    }
    SCALE_FACTORS_MAIN { en: "Main scale factors", ru: "Основные масштабные коэффициенты" }
    SCALE_FACTORS_CROSS { en: "Cross scale factors", ru: "Перекрёстные масштабные коэффициенты" }
    DRIFT_CONSTANT { en: "Constant drift", ru: "Постоянные составляющие дрейфа" }
    DRIFT_G { en: "Drift that depends on g", ru: "Составляющие дрейфа, зависящие от g" }
    VALUE { en: "Value", ru: "Значение" }
    NO_MATRICES {
        en: "Not all of the eight positions are certified: there are no matrices. A calibration is by \
             least squares, from the vectors below.",
        ru: "Аттестованы не все восемь положений: матриц нет. Калибровка — методом наименьших \
             квадратов по приведённым ниже векторам."
    }

    ACCURACY { en: "What the stand is good for", ru: "Точность калибровки на этом стенде" }
    ACCURACY_CAPTION {
        en: "Standard uncertainties (k = 1) of one calibration here by least squares, and the tolerances of the gyro's type",
        ru: "Стандартные неопределённости (k = 1) одной калибровки здесь методом наименьших квадратов и допуски типа гироскопа"
    }
    ACCURACY_NONE {
        en: "Not stated: the passport was issued without a type of gyro and a meter.",
        ru: "Не указана: паспорт выдан без типа гироскопа и прибора для измерения токов."
    }
    FIGURE_ACCURACY {
        en: "Figure 5. The uncertainties against the tolerances.",
        ru: "Рисунок 5. Неопределённости в сравнении с допусками."
    }
    GYRO_TYPE { en: "Type of gyro", ru: "Тип гироскопа" }
    GYRO_GRAVITY { en: "Its drifts are stated for g of", ru: "Его дрейфы указаны для g" }
    CALIBRATING_LABORATORY { en: "Calibrating laboratory", ru: "Калибрующая лаборатория" }
    METER { en: "Meter (k = 1)", ru: "Измеритель токов (k = 1)" }
    METER_WORDS {
        en: "of a reading {reading} %, of the gain {gain} %, of the offset {offset} mA, floor {floor} mA; range {range} mA",
        ru: "показания {reading} %, усиления {gain} %, смещения {offset} мА, порог {floor} мА; диапазон {range} мА"
    }
    METER_NOISE { en: "; noise of a reading {noise} mA", ru: "; шум показания {noise} мА" }
    SEATING { en: "u of the seat about x, y, z", ru: "u установки вокруг x, y, z" }
    BASE_AZIMUTH_U { en: "u of the base's azimuth there", ru: "u азимута основания там" }
    BASE_LEVEL_U { en: "u of the base's level there", ru: "u уровня основания там" }
    LABORATORY_TEMPERATURE { en: "Temperature there", ru: "Температура там" }
    NOMINAL { en: "Nominal", ru: "Номинал" }
    TOLERANCE { en: "Tolerance", ru: "Допуск" }

    ABSENCES { en: "What is not stated", ru: "Что не указано" }
    ABSENCES_NONE { en: "Nothing that the format can state is missing.", ru: "Указано всё, что предусмотрено форматом." }

    ANNEX { en: "Annex: the signed file", ru: "Приложение: подписанный файл" }
    ANNEX_NOTE {
        en: "The file as it was signed, to the letter; every number in it reads back as the same binary64. Saved as {name}, \
             with one line feed at the end of each line, it has the SHA-256 of the first page.",
        ru: "Файл в том виде, в каком он подписан, дословно; каждое число читается как то же самое binary64. Сохранённый под \
             именем {name}, с одним переводом строки в конце каждой строки, он имеет SHA-256, указанную на первой странице."
    }
    SAVE { en: "Save the signed file", ru: "Сохранить подписанный файл" }
    END { en: "End of the passport {id}", ru: "Конец паспорта {id}" }
}
