//! Enums each of whose variants is a word in files and results.

/// Declares an enum whose variants have words; the function after the colon returns the word, `ALL` is in the order of
/// declaration. With a second name after the colon, that function returns the second text of each variant.
macro_rules! words {
    ($(#[$about:meta])* $vis:vis enum $name:ident : $fn_vis:vis $word:ident, $more:ident {
        $($(#[$doc:meta])* $variant:ident = $text:literal, $other:literal;)*
    }) => {
        $crate::text::words! {
            $(#[$about])* $vis enum $name: $fn_vis $word { $($(#[$doc])* $variant = $text,)* }
        }

        impl $name {
            /// Returns the second text of the variant.
            fn $more(self) -> &'static str {
                match self { $(Self::$variant => $other,)* }
            }
        }
    };
    ($(#[$about:meta])* $vis:vis enum $name:ident : $fn_vis:vis $word:ident {
        $($(#[$doc:meta])* $variant:ident = $text:literal,)*
    }) => {
        $(#[$about])*
        $vis enum $name { $($(#[$doc])* $variant,)* }

        impl $name {
            #[allow(dead_code)]
            pub(crate) const ALL: [Self; [$($text),*].len()] = [$(Self::$variant),*];

            /// Returns the word of the variant in files and results.
            $fn_vis fn $word(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }
        }
    };
}

/// Lets an enum declared by [`words!`] be the value of a key. The text after the words says more of what is expected.
macro_rules! word_of_a_key {
    ($name:ident, $word:ident, $more:literal) => {
        const _: () = {
            use $crate::text::field::{Field, Scalar, Sink, refuse};
            use $crate::text::{Node, Path, Problems};

            impl Field for $name {
                fn read(node: &Node, at: &Path, problems: &mut Problems) -> Option<Self> {
                    let is_word = |one: &Self| matches!(node, Node::Text(text) if text == one.$word());
                    Self::ALL.into_iter().find(is_word).or_else(|| refuse(node, at, "", problems))
                }

                fn expected(_: &str) -> String {
                    $crate::text::words::listed(&Self::ALL.map(Self::$word)) + $more
                }

                fn emit<S: Sink>(&self, sink: &mut S) {
                    sink.scalar(Scalar::Text(self.$word()));
                }
            }
        };
    };
}
pub(crate) use {word_of_a_key, words};

/// Lists names, of many only the first five: a, b, c, d, e and 195 more.
pub(crate) fn first_few<T: AsRef<str>>(names: &[T]) -> String {
    const FEW: usize = 5;
    let list = names.iter().take(FEW).map(AsRef::as_ref).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(FEW) {
        0 => list,
        more => format!("{list} and {more} more"),
    }
}

/// Lists words in quotation marks: "a", "b" or "c".
pub(crate) fn listed(words: &[&str]) -> String {
    let quoted: Vec<String> = words.iter().map(|word| format!("{word:?}")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}
