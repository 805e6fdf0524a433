//! The checks of a verification, and what can be said of each on a page. What makes a page impossible is not here.

use super::texts;

texts! {
    CAPTION { en: "Checks at {time}", ru: "Проверки на {time}" }
    CHECK { en: "Check", ru: "Проверка" }
    RESULT { en: "Result", ru: "Результат" }
    FOUND { en: "What was found", ru: "Что установлено" }
    PASSED { en: "passed", ru: "пройдена" }
    FAILED { en: "FAILED", ru: "НЕ ПРОЙДЕНА" }

    IN_FORCE { en: "In force", ru: "Действует" }
    ALL_PASSED { en: "Every check passed at {time}.", ru: "Все проверки пройдены на {time}." }
    NOT_TO_BE_USED { en: "Not to be used", ru: "Не применять" }
    GENUINE {
        en: "The passport is genuine, but at {time} it may not be used, or not here.",
        ru: "Паспорт подлинный, но на {time} применять его нельзя или нельзя здесь."
    }
    EXPIRED { en: "expired", ru: "срок действия истёк" }
    NOT_YET { en: "not yet in force", ru: "ещё не вступил в силу" }
    ANOTHER_STAND { en: "of another stand", ru: "относится к другому стенду" }
    ANOTHER_PLACE { en: "for another place", ru: "выдан для другого места" }
    SUPERSEDED { en: "superseded", ru: "заменён другим паспортом" }
    WITHDRAWN { en: "withdrawn by its issuer", ru: "отозван выдавшей организацией" }
    REFUSED { en: "refused", ru: "отклонён" }

    GRAMMAR { en: "Form of the text", ru: "Форма текста" }
    GRAMMAR_OK {
        en: "the text is in the form that every reader reads alike",
        ru: "текст записан в той форме, которую все программы читают одинаково"
    }
    SIGNATURE { en: "Signature", ru: "Подпись" }
    SIGNATURE_OK { en: "the text is as the key signed it", ru: "текст таков, каким его подписал ключ" }
    SCHEMA { en: "Content", ru: "Содержание" }
    SCHEMA_OK {
        en: "the content is complete and obeys {format}",
        ru: "содержание полно и соответствует формату {format}"
    }
    SIGNER { en: "Signer", ru: "Подписавший" }
    SIGNER_OK { en: "the key is that of {issuer}", ru: "ключ принадлежит {issuer}" }
    REVOCATION { en: "Withdrawal", ru: "Отзыв" }
    REVOCATION_NO_LIST {
        en: "no list of revoked keys or withdrawn passports was given",
        ru: "список отозванных ключей или паспортов не предъявлен"
    }
    REVOCATION_KEYS_ONLY {
        en: "the key is not revoked; no list of withdrawn passports was given",
        ru: "ключ не отозван; список отозванных паспортов не предъявлен"
    }
    REVOCATION_LIST {
        en: "not withdrawn: list {sequence} of {time} does not name it",
        ru: "не отозван: в списке {sequence} от {time} его нет"
    }
    REVOCATION_WITHDRAWN {
        en: "withdrawn at {time}; the reason given: {reason}",
        ru: "отозван {time}; указанная причина: {reason}"
    }
    RECOMPUTED { en: "Numbers", ru: "Числа" }
    RECOMPUTED_OK {
        en: "every number, computed again, follows from the signed deviations and site",
        ru: "все числа при повторном вычислении следуют из подписанных отклонений и места"
    }
    VALIDITY { en: "Validity", ru: "Срок действия" }
    VALIDITY_OK { en: "issued, and in force to {day}", ru: "выдан и действует по {day}" }
    VALIDITY_NO_END {
        en: "issued; neither passport nor certificate names a last day",
        ru: "выдан; ни в паспорте, ни в сертификате последний день не указан"
    }
    VALIDITY_EXPIRED {
        en: "the last day was {day}: ask the issuer for a new passport",
        ru: "последним днём был {day}: запросите новый паспорт у выдавшей организации"
    }
    VALIDITY_CERTIFICATE_EXPIRED {
        en: "the certificate's last day was {day}: the stand must be certified again",
        ru: "последним днём сертификата был {day}: стенд нужно аттестовать снова"
    }
    VALIDITY_NOT_YET {
        en: "issued at {time}, later than the time asked about",
        ru: "выдан {time}, позже момента, о котором спрошено"
    }
    ISSUER { en: "Issuer", ru: "Кем выдан" }
    ISSUER_OK { en: "issued by {issuer}, as asked", ru: "выдан {issuer}, как и требовалось" }
    STAND { en: "Stand", ru: "Стенд" }
    STAND_OK { en: "of stand {serial}, as asked", ru: "относится к стенду {serial}, как и требовалось" }
    STAND_WRONG {
        en: "of stand {serial}, not of {asked}: its deviations are not that stand's",
        ru: "относится к стенду {serial}, а не к {asked}: отклонения другого стенда"
    }
    PLACE { en: "Place", ru: "Место" }
    PLACE_OK {
        en: "{distance} m from the site, valid within {radius} m",
        ru: "{distance} м от места поставки, действует в радиусе {radius} м"
    }
    PLACE_WRONG {
        en: "{distance} m from the site, valid within {radius} m: ask for a re-issue for this place",
        ru: "{distance} м от места поставки, действует в радиусе {radius} м: запросите перевыпуск для этого места"
    }
    REGISTER { en: "Register", ru: "Реестр" }
    REGISTER_OK { en: "nothing in the folder asked about supersedes it", ru: "в указанной папке его ничто не заменяет" }
    REGISTER_SUPERSEDED {
        en: "superseded by another passport in the folder asked about: use that one",
        ru: "в указанной папке есть заменяющий его паспорт: применяйте тот"
    }
    REGISTER_UNKNOWN {
        en: "not known: a file in the folder asked about is damaged or missing",
        ru: "неизвестно: в указанной папке повреждён или отсутствует файл"
    }
    NOT_RUN { en: "not run", ru: "не проводилась" }
}
