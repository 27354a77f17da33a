#define BOOST_TEST_MODULE misfit
#include <boost/test/unit_test.hpp>
