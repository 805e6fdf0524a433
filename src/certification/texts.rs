//! Texts of the remarks on a certification, and of the findings of a comparison with the last certificate, in all languages.
//! `{name}` is a placeholder for a value; `{p}` is a probability with its relation.

use crate::wording::texts;

texts! {
    OUTLIER { en: "Outlier", ru: "Выброс" }
    STRAGGLER { en: "Straggler", ru: "Квазивыброс" }
    WORSE {
        en: "{grade}: the standard deviation of position {index} is {ratio} times the pooled one (Cochran’s test, \
             {p}). Its uncertainty is computed from its own readings, that of the others without it.",
        ru: "{grade}: стандартное отклонение положения {index} в {ratio} раза больше объединённого (критерий Кохрена, \
             {p}). Неопределённость этого положения вычислена по его показаниям, остальных — без него."
    }
    WORSE_GROUP {
        en: "The standard deviation of the positions with θ = {theta}° is {ratio} times that of the others (F test, {p}). \
             Their uncertainty is computed from their own readings, that of the others without them. The repeatability is \
             pooled from all positions.",
        ru: "Стандартное отклонение положений с θ = {theta}° в {ratio} раза больше, чем у остальных (критерий Фишера, \
             {p}). Их неопределённость вычислена по их показаниям, остальных — без них. Указана повторяемость, \
             объединённая по всем положениям."
    }
    OUTLIER_READING {
        en: "{grade}: position {index}, run {run}, differs by {residual}″ about {axis} from the other runs (Grubbs’ test, \
             {p}). The reading was not excluded.",
        ru: "{grade}: положение {index}, серия {run}, отличие от других серий {residual}″ вокруг {axis} (критерий \
             Граббса, {p}). Показание не исключено."
    }
    OUTLIER_IN_LINE {
        en: "{grade}: position {index}, run {run} (line {line} of the readings), differs by {residual}″ about {axis} from \
             the other runs (Grubbs’ test, {p}). The reading was not excluded.",
        ru: "{grade}: положение {index}, серия {run} (строка {line} файла показаний), отличие от других серий \
             {residual}″ вокруг {axis} (критерий Граббса, {p}). Показание не исключено."
    }
    AXES_OF_PLATFORM { en: "x, y, z of the platform", ru: "осей x, y, z платформы" }
    AXES_OF_BASE { en: "east, north, up of the base", ru: "осей основания «восток», «север», «верх»" }
    BUMPED_RUN {
        en: "{grade}: all positions of run {run} are rotated by {x}″, {y}″, {z}″ about {axes} relative to the other \
             runs (Grubbs’ test, {p}). The run was not excluded; it changes certified deviations by up to {mean}″.",
        ru: "{grade}: все положения серии {run} повёрнуты относительно других серий на {x}″, {y}″, {z}″ вокруг {axes} \
             (критерий Граббса, {p}). Серия не исключена; она изменяет отклонения в сертификате не более чем на \
             {mean}″."
    }
    MOVED {
        en: "The stand seems to have moved between runs {run} and {after}: all positions are rotated by {x}″, {y}″, {z}″ \
             about {axes} (Student’s test of a step, {p}). No run was excluded; the certified deviations are a mean of both \
             states.",
        ru: "По-видимому, между сериями {run} и {after} стенд сместился: все положения повёрнуты на {x}″, {y}″, {z}″ \
             вокруг {axes} (критерий Стьюдента для смещения, {p}). Серии не исключены; отклонения в сертификате — среднее \
             по обоим состояниям."
    }
    DRIFTS {
        en: "The stand seems to drift: from run to run all positions rotate by {x}″, {y}″, {z}″ about {axes} (Student’s \
             test of a straight line, {p}). No run was excluded; the certified deviations are those of the middle of the \
             measurement.",
        ru: "По-видимому, стенд дрейфует: от серии к серии все положения поворачиваются на {x}″, {y}″, {z}″ вокруг {axes} \
             (критерий Стьюдента для дрейфа, {p}). Серии не исключены; отклонения в сертификате относятся к середине \
             измерений."
    }
    SPLIT_RUN {
        en: "The stand seems to have moved during run {run}: from position {after} on, its positions are rotated by {x}″, \
             {y}″, {z}″ about {axes} relative to those up to {before}, in the order of the rows (F test, {p}). The run \
             was not excluded; single readings and positions were not examined.",
        ru: "По-видимому, стенд сместился во время серии {run}: её положения начиная с {after} повёрнуты относительно \
             положений до {before} включительно (в порядке строк) на {x}″, {y}″, {z}″ вокруг {axes} (критерий Фишера, \
             {p}). Серия не исключена; отдельные показания и положения не проверялись."
    }
    TWO_RUNS {
        en: "Two runs do not show whether run {one} or run {other} is wrong; a third run is needed.",
        ru: "По двум сериям нельзя установить, какая из них ошибочна, {one} или {other}; требуется третья серия."
    }
    NOT_COMPARED {
        en: "Because a reading is suspect, the scatter of single positions was not tested; all positions state the \
             pooled standard deviation.",
        ru: "Из-за сомнительного показания рассеяние в отдельных положениях не проверялось; для всех указано объединённое \
             стандартное отклонение."
    }
    TWINS {
        en: "Runs {one} and {other} agree more than 30 times better than other runs; one may be a copy of \
             the other, or another run may contain an error.",
        ru: "Серии {one} и {other} согласуются более чем в 30 раз лучше остальных; возможно, одна \
             из них — копия другой, или ошибка содержится в другой серии."
    }
    AXES_DIFFER {
        en: "The variances about x, y and z differ (Bartlett’s test, {p}). The repeatability, pooled from all \
             three, is too large for one axis and too small for another.",
        ru: "Дисперсии вокруг x, y и z различаются (критерий Бартлетта, {p}). Указана повторяемость, объединённая по \
             трём осям: для одной оси она завышена, для другой занижена."
    }
    POSITIONS_DIFFER {
        en: "The variances of the positions differ (Bartlett’s test, {p}), although none is much larger than the others. The \
             repeatability, pooled from all positions, is too large for some and too small for others.",
        ru: "Дисперсии положений различаются (критерий Бартлетта, {p}), хотя ни одна не намного больше остальных. Указана \
             повторяемость, объединённая по всем положениям: для одних она завышена, для других занижена."
    }
    PLATFORM_AXES_DIFFER {
        en: "From run to run the standard deviation of the platform’s rotation is {own}″ about {axis} and {others}″ \
             about its other two axes (Cochran’s test, {p}). The common part is pooled from all three and is too small about {axis} unless a \
             component of type B of {missing}″ is stated, which allows for the {freedom} degrees of freedom of {own}″.",
        ru: "От серии к серии стандартное отклонение поворота платформы вокруг {axis} равно {own}″, вокруг двух других \
             осей {others}″ (критерий Кохрена, {p}). Общая составляющая, объединённая по трём осям, для {axis} занижена, \
             если не указана составляющая по типу B, равная {missing}″ (учтено число степеней свободы {freedom})."
    }
    BASE_AXES_DIFFER {
        en: "From run to run the standard deviation of the base’s rotation is {own}″ about {axis} and {others}″ about \
             its other two axes (Cochran’s test, {p}). The common part is pooled from all three and is too small about {axis} unless a component of \
             type B of {missing}″ is stated, which allows for the {freedom} degrees of freedom of {own}″.",
        ru: "От серии к серии стандартное отклонение поворота основания вокруг оси «{axis}» равно {own}″, вокруг двух \
             других осей {others}″ (критерий Кохрена, {p}). Общая составляющая, объединённая по трём осям, для оси \
             «{axis}» занижена, если не указана составляющая по типу B, равная {missing}″ (учтено число степеней свободы \
             {freedom})."
    }
    SHARED_SETTING {
        en: "In each run the positions with the same {angle} share an error with a standard deviation of {u}″ (F test, \
             {p}), as if {angle} were set once for all of them. The uncertainties take the errors of positions as \
             independent, and are too small. Both angles are to be set again before every position.",
        ru: "В каждой серии положения с одинаковым {angle} имеют общую погрешность со стандартным отклонением {u}″ \
             (критерий Фишера, {p}), как если бы {angle} устанавливался один раз для всех этих положений. \
             Неопределённости рассчитаны для независимых погрешностей положений и занижены. Оба угла следует \
             устанавливать заново перед каждым положением."
    }
    FEW_RUNS {
        en: "The common part is estimated from {runs} runs with {freedom} degrees of freedom; its relative uncertainty is \
             {doubt} %. Five runs or more are recommended.",
        ru: "Общая составляющая серии оценена при числе серий {runs} и числе степеней свободы {freedom}; относительная \
             неопределённость этой оценки {doubt} %. Рекомендуется не менее пяти серий."
    }
    BASE_NOT_SEEN {
        en: "In these positions a rotation of the base cannot be distinguished from one of the platform; the common part \
             of the platform includes both.",
        ru: "В этих положениях поворот основания неотличим от поворота платформы; общая составляющая платформы включает \
             оба."
    }
    BASE_IN_PART {
        en: "In these positions rotations of the base can be distinguished from those of the platform about {axes} of \
             three axes only; the common part of the platform includes the rest.",
        ru: "В этих положениях поворот основания отличим от поворота платформы не вокруг всех трёх осей (число осей: \
             {axes}); остальное включено в общую составляющую платформы."
    }
    ROUNDING {
        en: "The readings of {angles} of {all} angles vary by less than half their step of {step}″, so their mean does not \
             reduce the rounding; its standard uncertainty of {u}″ is included.",
        ru: "Показания {angles} из {all} углов изменяются менее чем на половину шага отсчёта {step}″, и усреднение не \
             уменьшает погрешность округления; её стандартная неопределённость {u}″ учтена."
    }
    SMALL_ANGLES {
        en: "No angle is larger than {largest}″; the angles may be in degrees instead of arcseconds.",
        ru: "Ни один угол не превышает {largest}″; возможно, углы указаны в градусах, а не в секундах."
    }
    LITTLE_SCATTER {
        en: "The visits scatter by only {scatter}″, less than the repeatability of any stand; the angles may be in \
             arcminutes instead of arcseconds.",
        ru: "Стандартное отклонение одной установки в положение — лишь {scatter}″, меньше, чем у любого стенда; возможно, \
             углы указаны в минутах, а не в секундах."
    }
    FAR_ANGLE {
        en: "{angle} of position {index} is {value}″; the angles of the other positions are up to {usual}″.",
        ru: "Угол {angle} положения {index} равен {value}″; у остальных положений — не более {usual}″."
    }
    TEMPERATURE {
        en: "A temperature of {value} °C is unusual for a laboratory.",
        ru: "Температура {value} °C необычна для лаборатории."
    }
    NOT_DATED {
        en: "The date of measurement is not stated; the date of issue is taken for it.",
        ru: "Дата измерений не указана; вместо неё принята дата выдачи."
    }
    NO_EXPIRY {
        en: "The previous certificate was valid until {until} (inclusive); this one has no expiry date.",
        ru: "Предыдущий сертификат действовал по {until} включительно; срок действия нового не указан."
    }
    OLD_MEASUREMENT {
        en: "The stand was measured on {performed}, more than a year before the certificate was issued on {issued}.",
        ru: "Углы стенда измерены {performed}, более чем за год до выдачи сертификата {issued}."
    }
    LONG_VALIDITY {
        en: "The certificate of {issued} is valid until {until} (inclusive), for more than ten years.",
        ru: "Сертификат от {issued} действителен по {until} включительно, более десяти лет."
    }
    OUTSIDE_RANGE {
        en: "The temperature of {value} °C is outside the certified range of {low} °C to {high} °C.",
        ru: "Температура {value} °C вне диапазона, указанного в сертификате: от {low} до {high} °C."
    }

    SETTING_CHANGED {
        en: "The positions with {symbol} = {angle}° have rotated by {turn}″ about the axis of {symbol} relative to the \
             others; no other change was found.",
        ru: "Положения с {symbol} = {angle}° повернулись на {turn}″ вокруг оси, вокруг которой отсчитывают {symbol}, \
             относительно остальных; других изменений не обнаружено."
    }
    WORN {
        en: "No more than half of the positions agree with each other, but the angles resemble the certificate \
             (correlation {r}): the stand has changed in most positions.",
        ru: "Между собой согласуется не более половины положений, но углы коррелируют с сертификатом (r = {r}): стенд \
             изменился в большинстве положений."
    }
    ANOTHER_STAND {
        en: "No more than half of the positions agree with each other, and the angles do not resemble the certificate: \
             this is another stand or another certificate, or the stand was rebuilt or damaged.",
        ru: "Между собой согласуется не более половины положений, и углы не коррелируют с сертификатом: это другой стенд \
             или другой сертификат либо стенд разбирали или повредили."
    }
    EXCHANGED {
        en: "Positions {one} and {other} are exchanged: each has the angles that the certificate states for the other.",
        ru: "Положения {one} и {other} переставлены: показания каждого соответствуют углам другого по сертификату."
    }
    SMALLER_UNIT {
        en: "The angles are those of the certificate divided by {factor}; they are in another unit.",
        ru: "Углы равны указанным в сертификате, делённым на {factor}; они выражены в других единицах."
    }
    LARGER_UNIT {
        en: "The angles are {factor} times those of the certificate; they are in another unit.",
        ru: "Углы равны указанным в сертификате, умноженным на {factor}; они выражены в других единицах."
    }
    OPPOSITE_SIGN {
        en: "The angles are those of the certificate with the opposite sign.",
        ru: "Углы равны указанным в сертификате с обратным знаком."
    }
    OTHER_AXES {
        en: "The angles are in other columns or have other signs than in the certificate (read → certified: {columns}).",
        ru: "Углы записаны в других столбцах или с другими знаками, чем в сертификате (показание → сертификат: {columns})."
    }
    SCATTERS_MORE {
        en: "The visits of the check scatter by {found}″, but the certificate states {certified}″ (F test, {p}). Either \
             the stand repeats worse, so that uncertainties from its certificate are too small, or the instrument of the \
             check reads worse.",
        ru: "Стандартное отклонение одной установки в положение при проверке {found}″, по сертификату {certified}″ \
             (критерий Фишера, {p}). Либо повторяемость стенда ухудшилась и неопределённости по его сертификату занижены, \
             либо больше погрешность прибора, которым выполнена проверка."
    }
    POSITION_CHANGED {
        en: "Position {index} has changed relative to the other positions: {x}″, {y}″, {z}″ about x, y, z.",
        ru: "Положение {index} изменилось относительно остальных: поворот на {x}″, {y}″, {z}″ вокруг x, y, z."
    }
    POSITION_STRAGGLES {
        en: "Position {index} differs from the others by {x}″, {y}″, {z}″ about x, y, z, slightly more than chance \
             explains; measure it again.",
        ru: "Положение {index} отличается от остальных на {x}″, {y}″, {z}″ вокруг x, y, z — несколько больше случайного; \
             следует измерить его ещё раз."
    }
    CHANGED_TOGETHER {
        en: "The positions have changed by more than the stated uncertainties explain; no single position stands out.",
        ru: "Изменения положений больше, чем объясняют указанные неопределённости; ни одно положение не выделяется."
    }
    CHANGED_SLIGHTLY {
        en: "The differences of the positions are slightly larger than chance explains; another run is needed.",
        ru: "Различия положений несколько больше случайных; требуется ещё одна серия."
    }
    ROTATED {
        en: "All positions have rotated together: a datum surface has changed (gyro seat, level or azimuth).",
        ru: "Все положения повернулись одинаково: изменилась базовая поверхность (посадочная, для горизонтирования или \
             ориентирования)."
    }
    ROTATED_SLIGHTLY {
        en: "The common rotation of all positions is slightly larger than chance explains; more runs are needed.",
        ru: "Общий поворот всех положений несколько больше случайного; требуются дополнительные серии."
    }
    CHECK_BUMPED {
        en: "All positions of run {run} are rotated by {x}″, {y}″, {z}″ about {axes} relative to the other \
             runs; the common rotation includes {of_x}″, {of_y}″, {of_z}″ of it.",
        ru: "Все положения серии {run} повёрнуты относительно других серий на {x}″, {y}″, {z}″ вокруг \
             {axes}; в общий поворот вошли {of_x}″, {of_y}″, {of_z}″."
    }
    CHECK_MOVED {
        en: "The stand seems to have moved between runs {run} and {after}: all positions are rotated by \
             {x}″, {y}″, {z}″ about {axes}; the common rotation is a mean of both states.",
        ru: "По-видимому, между сериями {run} и {after} стенд сместился: все положения повёрнуты на {x}″, \
             {y}″, {z}″ вокруг {axes}; общий поворот — среднее по обоим состояниям."
    }
    CHECK_DRIFTS {
        en: "The stand seems to drift: from run to run all positions rotate by {x}″, {y}″, {z}″ about \
             {axes}; the common rotation is that of the middle of the readings.",
        ru: "По-видимому, стенд дрейфует: от одной серии к другой все положения поворачиваются на {x}″, \
             {y}″, {z}″ вокруг {axes}; общий поворот относится к середине показаний."
    }
    CHECK_SPLIT {
        en: "The stand seems to have moved during run {run}: from position {after} on, its positions are \
             rotated by {x}″, {y}″, {z}″ about {axes} relative to those up to {before}, in the order of the rows.",
        ru: "По-видимому, стенд сместился во время серии {run}: её положения начиная с {after} повёрнуты \
             относительно положений до {before} включительно (в порядке строк) на {x}″, {y}″, {z}″ вокруг {axes}."
    }
    CHECK_OUTLIER {
        en: "The reading of position {index} in run {run} differs by {residual}″ about {axis} from those of \
             the other runs; this shifts the mean of the position by {mean}″.",
        ru: "Показание в положении {index}, серия {run}, отличается на {residual}″ вокруг {axis} от показаний \
             других серий; среднее для положения смещено этим на {mean}″."
    }
    NOT_TESTED_VARIATION {
        en: "Rotation of the stand as a whole was not tested: the scatter from run to run is unknown.",
        ru: "Общий поворот стенда не проверен: рассеяние от серии к серии неизвестно."
    }
    NOT_TESTED_RUNS {
        en: "Rotation of the stand as a whole was not tested: one run does not show the scatter between set-ups, and the \
             certificate does not state its number of runs.",
        ru: "Общий поворот стенда не проверен: одна серия не показывает рассеяния между выставками основания, а число \
             серий в сертификате не указано."
    }
    NOT_TESTED_COMMON_PARTS {
        en: "Rotation of the stand as a whole was not tested: the certificate does not state the common parts of the \
             uncertainty.",
        ru: "Общий поворот стенда не проверен: общие составляющие неопределённости в сертификате не указаны."
    }
    DETECTS {
        en: "A rotation of one position by {position}″, or of the platform by {platform}″, about an axis of the case \
             would be detected with a probability of 95 %.",
        ru: "Поворот одного положения на {position}″ или всей платформы на {platform}″ вокруг оси корпуса был бы \
             обнаружен с вероятностью 95 %."
    }
    DETECTS_OF_POSITION {
        en: "A rotation of one position by {position}″ about an axis of the case would be detected with a probability of \
             95 %.",
        ru: "Поворот одного положения на {position}″ вокруг оси корпуса был бы обнаружен с вероятностью 95 %."
    }
    TREATED_AS_EXACT {
        en: "Angles for which the certificate states no uncertainty were treated as exact, so differences appear more \
             significant than they are.",
        ru: "Углы, неопределённость которых в сертификате не указана, приняты точными, поэтому значимость различий \
             завышена."
    }
    TOO_CLOSE {
        en: "The readings agree with the certificate better than the repeatability of the stand allows; they may be those of \
             the certificate.",
        ru: "Показания согласуются с сертификатом лучше, чем допускает повторяемость стенда; возможно, по ним и выдан \
             сертификат."
    }
    SAME_READINGS {
        en: "The certificate was computed from these readings; they do not show the present state of the stand.",
        ru: "Данные сертификата вычислены по этим же показаниям; о нынешнем состоянии стенда они не свидетельствуют."
    }
}
