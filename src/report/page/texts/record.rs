//! Texts of the printed passport: the parts to fill in by hand, named according to GOST R 2.610-2019.

use super::texts;

texts! {
    LEFT_TO_THE_LABORATORY { en: "To be filled in by the laboratory of the certificate", ru: "Заполняет лаборатория, выдавшая сертификат" }
    CUSTOMER_CONTACT { en: "Contact of the customer", ru: "Контактные данные заказчика" }
    PLACE_OF_MEASUREMENT { en: "Place of measurement", ru: "Место проведения измерений" }
    CONDITION { en: "Condition of the stand", ru: "Состояние стенда" }
    MANUFACTURED { en: "Date of manufacture", ru: "Дата изготовления" }
    METHOD_CHANGES { en: "Deviations from the method", ru: "Отступления от методики" }
    ADJUSTMENT { en: "Results before adjustment or repair", ru: "Результаты до юстировки или ремонта" }
    EXTERNAL { en: "Results from external providers", ru: "Результаты внешних поставщиков" }
    SIGNATURE { en: "Signature", ru: "Подпись" }
    POST_AND_NAME { en: "Position and name", ru: "Должность, фамилия" }
    ISSUED_BY { en: "Issued by: position, name", ru: "Выдал: должность, фамилия" }

    RECORD { en: "Record of the stand", ru: "Учёт изделия" }
    ON_PAPER {
        en: "The forms of this section are filled in by hand on the printed passport.",
        ru: "Формы этого раздела заполняют от\u{a0}руки в отпечатанном паспорте."
    }
    COMPLETENESS { en: "Scope of delivery", ru: "Комплектность" }
    DESIGNATION { en: "Designation", ru: "Обозначение" }
    ITEM { en: "Item", ru: "Наименование" }
    QUANTITY { en: "Quantity", ru: "Кол-во" }
    NOTE { en: "Note", ru: "Примечание" }
    TEST_STAND { en: "Test stand", ru: "Поворотный стенд" }
    THIS_PASSPORT { en: "This passport (signed file)", ru: "Настоящий паспорт (подписанный файл)" }

    WARRANTY {
        en: "Service life, storage life and warranty",
        ru: "Ресурсы, сроки службы и хранения и гарантии изготовителя"
    }
    SERVICE_LIFE { en: "Service life", ru: "Срок службы" }
    STORAGE_LIFE { en: "Storage life", ru: "Срок хранения" }
    WARRANTY_PERIOD { en: "Warranty period", ru: "Гарантийный срок" }
    WARRANTY_TERMS { en: "Warranty terms", ru: "Условия гарантии" }

    PRESERVATION { en: "Preservation", ru: "Консервация" }
    DATE { en: "Date", ru: "Дата" }
    WORK { en: "Work performed", ru: "Наименование работы" }
    PERIOD { en: "Valid for, years", ru: "Срок действия, годы" }
    WHO { en: "Position, name, signature", ru: "Должность, фамилия, подпись" }

    PACKING { en: "Packing certificate", ru: "Свидетельство об упаковывании" }
    PACKING_WORDS {
        en: "Stand {model} No. {serial} has been packed by the organisation specified below in accordance with the \
             technical documentation in force.",
        ru: "Стенд {model} № {serial} упакован указанной ниже организацией согласно требованиям действующей \
             технической документации."
    }
    ACCEPTANCE { en: "Acceptance certificate", ru: "Свидетельство о приёмке" }
    ACCEPTANCE_WORDS {
        en: "Stand {model} No. {serial} has been manufactured and accepted in accordance with the mandatory \
             requirements of standards and the technical documentation in force, and has been found fit for use.",
        ru: "Стенд {model} № {serial} изготовлен и принят в соответствии с обязательными требованиями стандартов, \
             действующей технической документацией и признан годным для эксплуатации."
    }
    VALID_WHEN_SIGNED {
        en: "These two certificates are valid only with handwritten signatures.",
        ru: "Оба свидетельства действительны только с собственноручной подписью."
    }
    ORGANISATION { en: "Organisation", ru: "Организация" }
    STAMP { en: "Stamp", ru: "М. П." }

    STORAGE { en: "Storage and transport", ru: "Хранение и транспортирование" }
    STORAGE_CONDITIONS { en: "Storage conditions", ru: "Условия хранения" }
    TRANSPORT_CONDITIONS { en: "Transport conditions", ru: "Условия транспортирования" }

    MOVEMENT { en: "Relocation in use", ru: "Движение изделия в эксплуатации" }
    INSTALLED { en: "Date installed", ru: "Дата установки" }
    SITE { en: "Site", ru: "Место установки" }
    REMOVED { en: "Date removed", ru: "Дата снятия" }
    WHY_REMOVED { en: "Reason for removal", ru: "Причина снятия" }

    REPAIRS { en: "Repairs and service bulletins", ru: "Ремонт и учёт работы по бюллетеням и указаниям" }
    REPAIR { en: "Reason, work performed", ru: "Основание, работы" }
    CERTIFIED_AGAIN { en: "Recertification, certificate No.", ru: "Повторная калибровка, № сертификата" }

    NOTES { en: "Notes on use and storage", ru: "Заметки по эксплуатации и хранению" }
    DISPOSAL { en: "Disposal", ru: "Сведения об утилизации" }
    SPECIAL { en: "Special remarks", ru: "Особые отметки" }
    AFTER_A_MOVE {
        en: "After a repair, or a move beyond the validity radius, this passport must not be used until the stand has \
             been recertified or the passport re-issued.",
        ru: "После ремонта или перемещения за пределы радиуса применимости паспорт не применяют до повторной \
             калибровки или перевыпуска."
    }
}
