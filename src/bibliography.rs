//! Papers and standards from which the formulas come. A citation in the code is a link to a variant of `Bibliography`.

/// Source of formulas, constants or rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Bibliography {
    /// Tang Xingyuan and V. P. Podchezertsev, "Algorithms of dynamically tuned gyroscope certification under
    /// conditions of real-world orientation relative to the geographic coordinate system", Engineering Journal:
    /// Science and Innovation, 2017, no. 10, <https://doi.org/10.18698/2308-6033-2017-10-1691>.
    ///
    /// "The paper" everywhere in this crate; its equations are cited by number.
    Tang17,
    /// G. Petit and B. Luzum (eds.), IERS Conventions (2010), IERS Technical Note 36, table 1.2: the nominal mean
    /// angular velocity of the Earth, 7.292115e-5 rad/s.
    Iers10,
    /// NGA.STND.0036_1.0.0_WGS84, Department of Defense World Geodetic System 1984: the ellipsoid (chapter 3) and
    /// normal gravity (chapter 4, eq. 4-1 to 4-3).
    Wgs84,
    /// W. A. Heiskanen and H. Moritz, Physical Geodesy, Freeman, 1967: the deflection of the vertical and the
    /// Laplace correction of an azimuth (sections 2-20, 5-4), normal gravity above the ellipsoid (eq. 2-123).
    HeiskanenMoritz67,
    /// C. F. F. Karney, "Algorithms for geodesics", Journal of Geodesy 87, 2013, 43-55,
    /// <https://doi.org/10.1007/s00190-012-0578-z>.
    Karney13,
    /// JCGM 100:2008, Evaluation of measurement data: Guide to the expression of uncertainty in measurement.
    Gum,
    /// JCGM 101:2008, Evaluation of measurement data: Supplement 1 to the Guide: Propagation of distributions using a
    /// Monte Carlo method.
    Jcgm101,
    /// JCGM 102:2011, Evaluation of measurement data: Supplement 2 to the Guide: Extension to any number of output
    /// quantities.
    Jcgm102,
    /// NIST Statistical Reference Datasets, linear regression, <https://www.itl.nist.gov/div898/strd/>.
    NistStrd,
    /// JCGM 106:2012, Evaluation of measurement data: The role of measurement uncertainty in conformity assessment.
    Jcgm106,
    /// A. R. Didonato and A. H. Morris, "Algorithm 708: significant digit computation of the incomplete beta function
    /// ratios", ACM Transactions on Mathematical Software 18, 1992, 360-373, <https://doi.org/10.1145/131766.131776>.
    DidonatoMorris92,
    /// C. Loader, "Fast and accurate computation of binomial probabilities", 2000: deviance and Stirling's remainder.
    Loader00,
    /// M. G. Kenward and J. H. Roger, "Small sample inference for fixed effects from restricted maximum likelihood",
    /// Biometrics 53, 1997, 983-997, <https://doi.org/10.2307/2533558>: a Wald statistic as a scaled F.
    KenwardRoger97,
    /// R. C. Paule and J. Mandel, "Consensus values and weighting factors", Journal of Research of the National Bureau of
    /// Standards 87, 1982, 377-385, <https://doi.org/10.6028/jres.087.022>.
    PauleMandel82,
    /// W. Stefansky, "Rejecting outliers in factorial designs", Technometrics 14, 1972, 469-479,
    /// <https://doi.org/10.1080/00401706.1972.10488930>: the maximum normed residual.
    Stefansky72,
    /// B. Rosner, "Percentage points for a generalized ESD many-outlier procedure", Technometrics 25, 1983, 165-172,
    /// <https://doi.org/10.1080/00401706.1983.10487848>.
    Rosner83,
    /// R. D. Cook and C. J. Nachtsheim, "A comparison of algorithms for constructing exact D-optimal designs",
    /// Technometrics 22, 1980, 315-324, <https://doi.org/10.1080/00401706.1980.10486162>.
    CookNachtsheim80,
    /// ISO 5725-2:1994, Accuracy (trueness and precision) of measurement methods and results, part 2, 7.3: a value that
    /// fails the test at 1 % is an outlier; one that fails only at 5 % is a straggler.
    Iso5725,
    /// ISO/TS 28037:2010, Determination and use of straight-line calibration functions: clause 6, known uncertainties of
    /// the ordinates.
    Iso28037,
    /// S. Holm, "A simple sequentially rejective multiple test procedure", Scandinavian Journal of Statistics 6, 1979,
    /// 65-70.
    Holm79,
    /// S. R. Searle, G. Casella and C. E. McCulloch, Variance Components, Wiley, 1992: estimation by equating sums of
    /// squares to their expectations (chapter 5).
    Searle92,
    /// NIST/SEMATECH e-Handbook of Statistical Methods, <https://doi.org/10.18434/M32189>.
    NistHandbook,
    /// D. Blackman and S. Vigna, "Scrambled linear pseudorandom number generators", ACM Transactions on Mathematical
    /// Software 47, 2021, article 36, <https://doi.org/10.1145/3460772>: xoshiro256++.
    Xoshiro,
    /// G. E. P. Box and M. E. Muller, "A note on the generation of random normal deviates", Annals of Mathematical
    /// Statistics 29, 1958, 610-611.
    BoxMuller58,
    /// G. Marsaglia and W. W. Tsang, "A simple method for generating gamma variables", ACM Transactions on Mathematical
    /// Software 26, 2000, 363-372, <https://doi.org/10.1145/358407.358414>.
    MarsagliaTsang00,
    /// ISO/IEC 17025:2017, General requirements for the competence of testing and calibration laboratories: 7.8.2 and
    /// 7.8.4, contents of a calibration certificate.
    Iso17025,
    /// GOST R 2.610-2019, Unified system of design documentation, Rules for the execution of operating documents
    /// (ГОСТ Р 2.610-2019, ЕСКД. Правила выполнения эксплуатационных документов): the parts of a product's passport.
    GostR2610,
    /// ISO/IEC 18004:2015, QR Code bar code symbology specification.
    Iso18004,
}
