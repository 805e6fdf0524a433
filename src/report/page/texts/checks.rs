//! Texts of the checks of a verification and of their results. Failures for which no page is made are not included.

use super::texts;

texts! {
    CAPTION { en: "Checks of the passport as of {time}", ru: "Проверки паспорта по состоянию на\u{a0}{time}" }
    CHECK { en: "Check", ru: "Проверка" }
    RESULT { en: "Result", ru: "Результат" }
    FOUND { en: "Finding", ru: "Пояснение" }
    PASSED { en: "passed", ru: "пройдено" }
    FAILED { en: "FAILED", ru: "НЕ\u{a0}ПРОЙДЕНО" }

    NOT_ASKED { en: "not asked", ru: "не запрошено" }
    COUNTED {
        en: "Checks as of {time}: {passed} passed, {not_asked} not asked.",
        ru: "Проверки по состоянию на\u{a0}{time}: пройдено\u{a0}{passed}, не\u{a0}запрошено\u{a0}{not_asked}."
    }
    COUNTED_FAILED {
        en: "Checks as of {time}: {passed} passed, {not_asked} not asked, {failed}\u{a0}failed.",
        ru: "Проверки по состоянию на\u{a0}{time}: пройдено\u{a0}{passed}, не\u{a0}запрошено\u{a0}{not_asked}, \
             не\u{a0}пройдено\u{a0}{failed}."
    }

    IN_FORCE { en: "In force", ru: "Действует" }
    NOT_TO_BE_USED { en: "Not to be used", ru: "Не применять" }
    GENUINE { en: "The passport is authentic. As of {time}:", ru: "Паспорт подлинный. На {time}:" }
    EXPIRED { en: "expired", ru: "срок действия истёк" }
    NOT_YET { en: "not yet in force", ru: "ещё не вступил в силу" }
    ANOTHER_STAND { en: "issued for another stand", ru: "относится к другому стенду" }
    ANOTHER_PLACE { en: "issued for another site", ru: "выдан для другого места установки" }
    SUPERSEDED { en: "superseded", ru: "заменён другим паспортом" }
    MOVED { en: "the stand has left this site", ru: "стенд покинул это место установки" }
    WITHDRAWN { en: "withdrawn by its issuer", ru: "отозван выдавшей организацией" }
    REFUSED { en: "rejected", ru: "отклонён" }

    GRAMMAR { en: "Form of the file", ru: "Форма" }
    GRAMMAR_OK {
        en: "all programs read it alike; it ends with a signature",
        ru: "все программы читают файл одинаково; в конце стоит подпись"
    }
    SIGNATURE { en: "Signature", ru: "Подпись" }
    SIGNATURE_OK { en: "the signature is correct; the text has not changed", ru: "подпись верна, текст не изменён" }
    SCHEMA { en: "Content", ru: "Содержание" }
    SCHEMA_OK {
        en: "the content is complete and conforms to {format}",
        ru: "содержание полно и соответствует формату {format}"
    }
    SIGNER { en: "Signing key", ru: "Ключ подписи" }
    SIGNER_OK { en: "the key belongs to {issuer}", ru: "владелец ключа: {issuer}" }
    REVOCATION { en: "Revocation", ru: "Отзыв" }
    REVOCATION_NO_LIST { en: "no list of revoked keys was given", ru: "список отозванных ключей не предъявлен" }
    REVOCATION_OK { en: "the key is not revoked", ru: "ключ не отозван" }
    RECOMPUTED { en: "Numbers", ru: "Числа" }
    RECOMPUTED_OK {
        en: "all numbers, recomputed, agree with the signed deviations and site",
        ru: "все числа подтверждены повторным вычислением"
    }
    VALIDITY { en: "Validity period", ru: "Срок действия" }
    VALIDITY_OK { en: "issued; valid until {day} (inclusive)", ru: "выдан; действителен по {day} включительно" }
    VALIDITY_NO_END {
        en: "issued; neither the passport nor the certificate has an expiry date",
        ru: "выдан; ни в паспорте, ни в сертификате срок действия не указан"
    }
    VALIDITY_EXPIRED {
        en: "valid until {day} (inclusive); request a new passport from the issuer",
        ru: "действовал по {day} включительно; следует запросить новый паспорт у выдавшей организации"
    }
    VALIDITY_CERTIFICATE_EXPIRED {
        en: "the certificate was valid until {day} (inclusive); have the stand recertified",
        ru: "сертификат действовал по {day} включительно; требуется повторная калибровка стенда"
    }
    VALIDITY_NOT_YET {
        en: "issued at {time}, later than the time of verification",
        ru: "выдан {time}, позже момента проверки"
    }
    ISSUER { en: "Issuer", ru: "Организация" }
    ISSUER_OK { en: "issued by {issuer}, as required", ru: "выдавшая организация: {issuer}, как требовалось" }
    ISSUER_NOT_ASKED { en: "no issuer was required", ru: "выдавшая организация не задана" }
    STAND { en: "Stand", ru: "Стенд" }
    STAND_OK { en: "for stand {serial}, as required", ru: "относится к стенду {serial}, как требовалось" }
    STAND_WRONG {
        en: "the passport is for stand {serial}, not {asked}; its deviations do not apply to that stand",
        ru: "паспорт относится к стенду {serial}, а не к {asked}; отклонения другого стенда неприменимы"
    }
    STAND_NOT_ASKED { en: "no serial number was given", ru: "заводской номер не задан" }
    PLACE { en: "Place", ru: "Место" }
    PLACE_OK {
        en: "the stand is {distance} from the site; validity radius {radius}",
        ru: "стенд в {distance} от места установки по паспорту; радиус применимости {radius}"
    }
    PLACE_WRONG {
        en: "the stand is {distance} from the site of the passport, outside the validity radius of {radius}; request a \
             re-issue for the new site",
        ru: "стенд в {distance} от места установки по паспорту, за пределами радиуса применимости {radius}; следует \
             запросить перевыпуск для нового места"
    }
    PLACE_NOT_ASKED { en: "no place was given", ru: "место не задано" }
    REGISTER { en: "Register", ru: "Реестр" }
    REGISTER_OK { en: "current", ru: "паспорт действует" }
    REGISTER_SUPERSEDED {
        en: "superseded by another passport; this one is not in force",
        ru: "заменён другим паспортом; этот паспорт не действует"
    }
    REGISTER_MOVED {
        en: "the stand has left this site; this passport is not in force",
        ru: "стенд покинул это место установки; этот паспорт не действует"
    }
    REGISTER_WITHDRAWN { en: "withdrawn by the issuer", ru: "отозван выдавшей организацией" }
    REGISTER_NOT_LISTED { en: "the register does not list this passport", ru: "паспорта нет в реестре" }
    REGISTER_STALE { en: "the register is no longer fresh", ru: "срок актуальности реестра истёк" }
    REGISTER_OLDER { en: "a later register is known", ru: "известен более поздний реестр" }
    REGISTER_CONTRADICTED { en: "two registers contradict each other", ru: "два реестра противоречат друг другу" }
    REGISTER_UNKNOWN {
        en: "unknown: no register of this stand that counts was given",
        ru: "неизвестно: действительный реестр этого стенда не предъявлен"
    }
    REGISTER_USED {
        en: "register {sequence} of {time}, SHA-256 {sha256}…{fresh}",
        ru: "реестр {sequence} от {time}, SHA-256 {sha256}…{fresh}"
    }
    REGISTER_FRESH { en: ", fresh until {day} (inclusive)", ru: ", актуален по {day} включительно" }
    REGISTER_NOT_ASKED { en: "no register was given", ru: "реестр не предъявлен" }
    NOT_RUN { en: "not run", ru: "не проводилось" }
}
