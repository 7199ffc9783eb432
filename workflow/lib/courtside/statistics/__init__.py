"""Statistics: agreement of two methods, change over sessions, dependent samples.

agreement: `pair`, `compare`, `verdict`, `limits`, `smallest_detectable_change`
longitudinal: `read`, `of_subject`, `over_sessions`, `errors_of_measurement`, `changes`,
    `of_study`, `labelled`, `check_single`
autocorrelation: `share`, `interval`, `frames_per_trial`, `covariance_of_sum`, `distinct`
intervals: `bootstrap`: of averages over halls, whose trials share pictures and persons
normal_errors: `mahalanobis`, `ellipsoid`, `one_more`, `decimals`, and factors of a standard
    deviation
moving_blocks: `counts`: takes drawn again, for intervals
"""
