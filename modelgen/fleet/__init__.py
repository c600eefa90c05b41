"""The logs of many arms diagnosed as one job."""
