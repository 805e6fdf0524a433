//! The printable passport: the parts that are filled in with a pen, named after GOST R 2.610-2019.

use super::texts;

texts! {
    LEFT_TO_THE_LABORATORY { en: "To be filled in by the laboratory", ru: "Заполняет лаборатория" }
    CUSTOMER_CONTACT { en: "Customer's contact", ru: "Контактные данные заказчика" }
    PLACE_OF_MEASUREMENT { en: "Place of the measurement", ru: "Место проведения измерений" }
    CONDITION { en: "Condition of the stand", ru: "Состояние стенда" }
    MANUFACTURED { en: "Date of manufacture", ru: "Дата изготовления" }
    METHOD_CHANGES { en: "Changes to the method", ru: "Отступления от методики" }
    ADJUSTMENT { en: "Before adjustment or repair", ru: "До юстировки или ремонта" }
    EXTERNAL { en: "Results from others", ru: "Сторонние результаты" }
    SIGNATURE { en: "Signature", ru: "Подпись" }

    RECORD { en: "The stand's record", ru: "Учёт изделия" }
    COMPLETENESS { en: "Completeness", ru: "Комплектность" }
    DESIGNATION { en: "Designation", ru: "Обозначение" }
    ITEM { en: "Item", ru: "Наименование" }
    QUANTITY { en: "Quantity", ru: "Кол-во" }
    SERIAL { en: "Serial number", ru: "Заводской номер" }
    NOTE { en: "Note", ru: "Примечание" }
    TEST_STAND { en: "Test stand", ru: "Испытательный стенд" }
    THIS_PASSPORT { en: "This passport, as a signed file", ru: "Настоящий паспорт, подписанный файл" }

    WARRANTY {
        en: "Service life, storage life and warranty",
        ru: "Ресурсы, сроки службы и хранения и гарантии изготовителя"
    }
    SERVICE_LIFE { en: "Service life", ru: "Срок службы" }
    STORAGE_LIFE { en: "Storage life", ru: "Срок хранения" }
    WARRANTY_PERIOD { en: "Warranty period", ru: "Гарантийный срок" }
    WARRANTY_TERMS { en: "Terms of the warranty", ru: "Условия гарантии" }

    PRESERVATION { en: "Preservation", ru: "Консервация" }
    DATE { en: "Date", ru: "Дата" }
    WORK { en: "Work done", ru: "Наименование работы" }
    PERIOD { en: "Good for, years", ru: "Срок действия, годы" }
    WHO { en: "Post, name, signature", ru: "Должность, фамилия, подпись" }

    PACKING { en: "Certificate of packing", ru: "Свидетельство об упаковывании" }
    PACKING_WORDS {
        en: "Stand {model} No. {serial} was packed by the maker named below as the technical documents in force require.",
        ru: "Стенд {model} № {serial} упакован указанной ниже организацией согласно требованиям действующей технической \
             документации."
    }
    ACCEPTANCE { en: "Certificate of acceptance", ru: "Свидетельство о приёмке" }
    ACCEPTANCE_WORDS {
        en: "Stand {model} No. {serial} was made and accepted as the mandatory requirements of standards and the technical \
             documents in force require, and found fit for use.",
        ru: "Стенд {model} № {serial} изготовлен и принят в соответствии с обязательными требованиями стандартов, действующей \
             технической документацией и признан годным для эксплуатации."
    }
    VALID_WHEN_SIGNED {
        en: "These two certificates count only when signed by hand.",
        ru: "Оба свидетельства действительны только с собственноручной подписью."
    }
    ORGANISATION { en: "Organisation", ru: "Организация" }
    STAMP { en: "Stamp", ru: "М. П." }

    STORAGE { en: "Storage and transport", ru: "Хранение и транспортирование" }
    STORAGE_CONDITIONS { en: "Conditions of storage", ru: "Условия хранения" }
    TRANSPORT_CONDITIONS { en: "Conditions of transport", ru: "Условия транспортирования" }

    MOVEMENT { en: "Movement in use", ru: "Движение изделия в эксплуатации" }
    INSTALLED { en: "Installed, date", ru: "Дата установки" }
    WHERE { en: "Where", ru: "Где установлено" }
    REMOVED { en: "Removed, date", ru: "Дата снятия" }
    WHY_REMOVED { en: "Why removed", ru: "Причина снятия" }

    REPAIRS { en: "Repairs, and work under bulletins", ru: "Ремонт и учёт работы по бюллетеням и указаниям" }
    REPAIR { en: "Reason, work done", ru: "Основание, выполненные работы" }
    CERTIFIED_AGAIN { en: "Certified again, certificate", ru: "Повторная аттестация, сертификат" }

    NOTES { en: "Notes on use and storage", ru: "Заметки по эксплуатации и хранению" }
    DISPOSAL { en: "Disposal", ru: "Сведения об утилизации" }
    SPECIAL { en: "Special marks", ru: "Особые отметки" }
    AFTER_A_MOVE {
        en: "A repair, or a move beyond the radius of validity, ends the use of this passport until the factory has certified \
             the stand or re-issued the passport.",
        ru: "После ремонта или перемещения за пределы радиуса действия паспорт не применяют, пока завод не аттестует стенд или \
             не перевыпустит паспорт."
    }
}
